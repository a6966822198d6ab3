// SPDX-License-Identifier: Apache-2.0
// How the camera has turned between two images that took part in an update: by their features, with the distances that
// the first of them left. Real-time thread; memory from the arena.
#pragma once

#include <span>

#include "estimator/vision/feature_frame.hpp"
#include "estimator/vision/feature_track.hpp"
#include "estimator/vision/reprojection.hpp"
#include "estimator/vision/turn_guess.hpp"
#include "rt/arena.hpp"
#include "rt/time.hpp"

namespace lxd {

struct ImageTurn {
  RigTime then, now;                                          // stamps of the images
  Eigen::Matrix3d R_then_now = Eigen::Matrix3d::Identity();   // of the camera
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Zero();  // of a right perturbation
};

// An image after its update.
struct ConcludedImage {
  RigTime stamp;
  Pose T_world_camera;
  std::span<const FeatureTrack> tracks;
  const FeatureWindow& window;
};

class TurnMeter {
 public:
  TurnMeter(const MountedCamera& camera, double pixel_sigma_px, Arena& arena);

  // The turn since the image before, which `now` takes the place of. shift_variance_m2: of where the camera was in one
  // of the two images, an axis. False: there is none, or their features do not tell.
  bool turn_to(const ConcludedImage& now, double shift_variance_m2, ImageTurn& turn) noexcept;

  void clear() { count_ = 0; }

 private:
  struct Remembered {
    std::uint32_t id;
    Eigen::Vector3d bearing;
    double rho, rho_sigma;
  };
  [[nodiscard]] std::span<const TurnPair> pairs_with(std::span<const FeatureTrack> tracks) noexcept;
  void remember(const ConcludedImage& image) noexcept;

  double sigma_rad_;  // of a bearing of one image against that of another
  std::span<Remembered> before_;
  std::size_t count_ = 0;
  std::span<TurnPair> pairs_;
  RigTime stamp_ = kNever;
  Pose T_world_camera_;
};

}  // namespace lxd
