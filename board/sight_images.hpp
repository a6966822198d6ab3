// SPDX-License-Identifier: Apache-2.0
// A camera's last images in grey, until it is known whether a key frame wants them. Whoever reads the camera puts them
// here, the thread that writes the run takes them out; neither is a real-time one.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>

#include "drivers/replay/image_file.hpp"
#include "rt/time.hpp"

namespace lxd {

class SightImages {
 public:
  // bytes: of pixels, at most, but for the last two images.
  explicit SightImages(std::size_t bytes) : bytes_max_(bytes) {}

  // In order of time. The oldest make room.
  void offer(const GreyPixels& pixels, RigTime instant);
  // Of that instant; null: it made room. It and older ones leave.
  [[nodiscard]] std::shared_ptr<const GreyPixels> take(RigTime instant);
  [[nodiscard]] std::size_t bytes();

 private:
  struct Waiting {
    RigTime instant;
    std::shared_ptr<const GreyPixels> pixels;
  };
  void drop_oldest();

  std::size_t bytes_max_, bytes_ = 0;
  std::mutex mutex_;
  std::deque<Waiting> images_;
};

}  // namespace lxd
