// SPDX-License-Identifier: Apache-2.0
// The key images that wait for the sub-meshes that they show: one for every new place or direction, and never more than
// there is room for. Low priority; one thread.
#pragma once

#include <cstddef>
#include <vector>

#include "backend/colour/key_image.hpp"

namespace lxd {

class KeyImages {
 public:
  // bytes: of pixels, at most.
  explicit KeyImages(std::size_t bytes) : bytes_max_(bytes) {}

  // Is what is seen from there new, among the images since the sub-mesh's begin? Surfaces at scene_m have turned by ten
  // degrees, because the camera moved (by half a metre at least, or two) or turned.
  [[nodiscard]] bool wants(const Pose& T_world_camera, double scene_m, RigTime begin) const;
  // Where there is no room, the one goes that differs least from the others.
  void add(KeyImage image);
  // Those up to a time, in order; they leave.
  std::vector<KeyImage> take_until(RigTime last);
  void clear();

  [[nodiscard]] std::size_t size() const { return images_.size(); }
  [[nodiscard]] std::size_t dropped() const { return dropped_; }  // had no room

 private:
  void drop_least();

  std::size_t bytes_max_, bytes_ = 0, dropped_ = 0;
  std::vector<KeyImage> images_;  // in order of time
};

}  // namespace lxd
