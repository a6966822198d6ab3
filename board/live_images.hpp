// SPDX-License-Identifier: Apache-2.0
// A live camera's frames as the images that a replay of their recording gives: grey, in order, each of the instant that
// its stamp or its trigger tells. The thread that reads the camera; triggers come from another.
#pragma once

#include <array>
#include <cstdint>

#include "board/rig.hpp"
#include "drivers/camera/frame_timing.hpp"
#include "drivers/camera/pixel_format.hpp"
#include "drivers/device/device.hpp"
#include "drivers/replay/camera_folder.hpp"
#include "drivers/replay/stamp_gate.hpp"
#include "rt/spsc_ring.hpp"

namespace lxd {

class LiveImages {
 public:
  // Of the rig's camera0. Memory for its images is taken here.
  explicit LiveImages(const Rig& rig);

  // Another thread, one alone.
  void add_trigger(RigTime edge) { triggers_no_room_ += !triggers_.push(edge); }

  // Frames are read in colour, too, one in a while; before the first.
  void want_colour();
  // A frame. When none of the images that wait was taken in time, the oldest makes room: it is `late`.
  void take(const Chunk& chunk);
  // The oldest image whose instant is known; null: none yet. It stays until it is dropped.
  [[nodiscard]] const CameraImage* front(RigTime now);
  // The same in colour; null: it was not one of those.
  [[nodiscard]] const ColourPixels* front_colour() const;
  void drop_front();
  [[nodiscard]] bool waiting() const { return count_ > 0; }

  // When no other thread is at work.
  [[nodiscard]] Rejections rejected() const;

 private:
  static constexpr std::size_t kImages = 4, kTriggers = 64;
  struct Waiting {
    CameraImage image;
    ColourPixels colour;
    bool coloured = false;
    bool sound = false;   // its pixels could be read
    bool placed = false;  // its instant is known
  };

  [[nodiscard]] Waiting& oldest() { return images_[first_ % kImages]; }
  [[nodiscard]] Result<PixelConverter> converter_of(const Chunk& chunk) const;
  bool read_pixels(const Chunk& chunk, GreyPixels& pixels);
  bool read_colour(const Chunk& chunk, RigTime begin, ColourPixels& pixels);
  bool place(Waiting& waiting, RigTime now);

  CameraRig rig_;
  PixelFormat format_;
  ExposureTiming timing_;
  FrameClock clock_;
  StampGate gate_;
  std::array<Waiting, kImages> images_;  // a ring
  std::size_t first_ = 0, count_ = 0;
  std::uint32_t number_ = 0;
  bool wants_colour_ = false;
  RigTime coloured_ = kNever;  // the last that was read in colour
  std::array<RigTime, kTriggers> trigger_slots_{};
  SpscRing<RigTime> triggers_{trigger_slots_};
  std::uint64_t triggers_no_room_ = 0;  // the other thread's
  Rejections rejected_;
};

}  // namespace lxd
