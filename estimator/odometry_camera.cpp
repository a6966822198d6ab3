// SPDX-License-Identifier: Apache-2.0
// The image in a sweep's life: its part in the update, and what it tells of the camera's clock and mount.
#include "estimator/odometry.hpp"
#include "rt/stopwatch.hpp"

namespace lxd {

// Reprojection residuals of the image's landmarks.
NormalEquations Odometry::see_features(int iteration) {
  if (!image_in_hand_) return {};
  const Stopwatch begun;
  const PathKnot knot = motion_.knot(filter_.state(), vision_->instant(), end_);
  NormalEquations sums = vision_->sums(knot, image_variance_, kernel_sigmas(iteration));
  outcome_.times.visual_update = outcome_.times.visual_update + begun.elapsed();
  return sums;
}

void Odometry::conclude_image() {
  if (image_in_hand_) vision_->conclude(pose_at(vision_->instant()), image_variance_, map_);
  if (!vision_->alignment().known()) align_camera();
}

// The gyroscope tells the turn between any two images. Without it the LiDAR tells the attitude in the middle of each
// sweep, which hangs least on how the rates are believed: of sweeps that hold it, not of those that images carry.
void Odometry::align_camera() {
  CameraAlignment& alignment = vision_->alignment();
  alignment.pass(end_ - last_end_);
  const ImageTurn* const seen = vision_->turn();
  if (motion_.inertial()) {
    alignment.forget_path();
    if (seen != nullptr) alignment.compare(*seen, [this](RigTime then, RigTime now) { return turn(then, now); });
  } else if (outcome_.tracked && outcome_.points_used >= kResidualsMin && outcome_.degenerate_directions == 0) {
    const RigTime middle = begin_ + (end_ - begin_) / 2;
    alignment.follow(middle, pose_at(middle).R, seen);
  } else {
    alignment.forget_path();
  }
}

}  // namespace lxd
