// SPDX-License-Identifier: Apache-2.0
// How the camera has turned between two images, told by the features of both alone (design 6.4: the vision rotation
// guess). Features whose distance is known are put where the camera's way lets them appear, and the way is corrected
// with the turn; of the others far ones move by the turn only. Near ones of unknown distance, and what moves by itself,
// are outliers. Real-time safe.
#pragma once

#include <cstdint>
#include <span>

#include "rt/pose.hpp"
#include "rt/so3.hpp"

namespace lxd {

// A feature in both images.
struct TurnPair {
  Eigen::Vector3d before, now;    // unit bearings, in the camera of each time
  double rho = 0, rho_sigma = 0;  // one over its distance from the camera then, 1/m
};

struct TurnExpected {
  Pose T_now_before;         // of the camera
  double shift_sigma_m = 0;  // of its way, an axis; 0: it is what it is
};

struct TurnGuess {
  Eigen::Matrix3d R_now_before;     // bearings of the camera then to those of the camera now
  Eigen::Matrix3d covariance_rad2;  // of a right perturbation, by the scatter of those that agree
  std::uint32_t features;           // in both images
  double agreement;                 // 0..1: mean weight of the features
};

// Starts at what is expected; its turn does not pull. sigma_rad: noise of a bearing. False: fewer than eight common
// features, or they do not fix the turn.
bool guess_turn(std::span<const TurnPair> pairs, const TurnExpected& expected, double sigma_rad,
                TurnGuess& guess) noexcept;

}  // namespace lxd
