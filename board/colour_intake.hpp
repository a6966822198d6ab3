// SPDX-License-Identifier: Apache-2.0
// Chooses key images: of those that a camera took, the ones that show something new, from where the filter has them.
// The thread that writes the run.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>

#include "backend/colour/key_images.hpp"
#include "board/colour_camera.hpp"
#include "estimator/sweep_outcome.hpp"

namespace lxd {

struct ColourOffer {
  RigTime instant;    // the middle of the exposure, by the camera's stamps
  Duration exposure;  // zero: not known
  std::optional<double> gain;
  // Asked for chosen ones alone, as it takes some milliseconds. Red, green, blue of the colour camera's view; empty: it
  // cannot be read.
  std::function<std::vector<std::uint8_t>()> key_pixels;
};

class ColourIntake {
 public:
  // bytes: of the images that wait for their sub-meshes, at most.
  ColourIntake(const Eigen::Vector3d& camera_in_body_m, std::size_t bytes)
      : camera_in_body_m_(camera_in_body_m), images_(bytes) {}

  // In order of time.
  void offer(ColourOffer offer);
  // Of what was offered up to this pose some is chosen now. begin: of the sub-mesh that is being built.
  void place(const SweepOutcome& outcome, RigTime begin);
  // The filter begins again: nothing that waits has a sub-mesh any more.
  void begin_again();

  [[nodiscard]] KeyImages& images() { return images_; }

 private:
  struct Placed {
    RigTime stamp;
    Pose T_world_body;
    bool tracked;
  };
  void choose(const ColourOffer& offer, RigTime taken, const Pose& T_body_camera, RigTime begin);

  Eigen::Vector3d camera_in_body_m_;  // how it is turned there the filter finds
  std::deque<ColourOffer> offers_;
  double scene_m_ = 0;       // from the LiDAR to half of its last points
  std::deque<Placed> path_;  // its last poses: a live camera's image comes later than the sweeps around it
  KeyImages images_;
};

}  // namespace lxd
