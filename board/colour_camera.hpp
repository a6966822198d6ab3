// SPDX-License-Identifier: Apache-2.0
// Makes key images of a camera's: its lens taken out, averaged down to what vertices need. Low priority.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "backend/colour/key_image.hpp"
#include "drivers/replay/image_file.hpp"
#include "estimator/vision/reprojection.hpp"

namespace lxd {

class ColourCamera {
 public:
  explicit ColourCamera(const MountedCamera& camera);

  [[nodiscard]] const PinholeView& view() const { return view_; }
  [[nodiscard]] const Pose& T_body_camera() const { return T_body_camera_; }
  // Red, green, blue; blind where the image is overexposed or ends. Empty: an image of another size.
  [[nodiscard]] std::vector<std::uint8_t> key_pixels(const ColourPixels& image) const;

 private:
  std::array<std::uint32_t, 2> resolution_;
  Pose T_body_camera_;
  PinholeView view_;
  std::vector<Eigen::Vector2f> sources_;  // of each pixel of the view: where it is in the image; off it: not finite
  int taps_ = 1;                          // a side, that a pixel is averaged over
  float tap_px_ = 1;                      // of the image, between them
};

}  // namespace lxd
