// SPDX-License-Identifier: Apache-2.0
// How the camera has turned between two images, told by the features of both alone (design 6.4: the vision rotation
// guess). Features that are far away move by the turn only; near ones, and what moves by itself, are outliers to it.
// Real-time safe.
#pragma once

#include <Eigen/Core>

#include "estimator/vision/feature_frame.hpp"

namespace lxd {

struct TurnGuess {
  Eigen::Matrix3d R_now_before;     // bearings of the camera then to those of the camera now
  Eigen::Matrix3d covariance_rad2;  // of a right perturbation, by the scatter of those that agree
  std::uint32_t features;           // in both images
  double agreement;                 // 0..1: mean weight of the features
};

// Starts at the turn that is expected. sigma_rad: noise of a bearing. False: fewer than eight common features, or they
// do not fix the turn.
bool guess_turn(const FeatureFrame& before, const FeatureFrame& now, const Eigen::Matrix3d& R_expected,
                double sigma_rad, TurnGuess& guess) noexcept;

}  // namespace lxd
