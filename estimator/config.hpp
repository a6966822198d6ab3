// SPDX-License-Identifier: Apache-2.0
// Every number of the filter that a user may set, with its default. One set serves every sensor and carrier.
#pragma once

#include "estimator/vision/config.hpp"

namespace lxd {

struct EstimatorConfig {
  // Propagation: constant velocity driven by white noise on the accelerations, roots of its power spectral densities.
  double acceleration_density = 1.0;          // m/s^2/sqrt(Hz)
  double angular_acceleration_density = 2.0;  // rad/s^2/sqrt(Hz)
  double gap_max_s = 1.0;                     // sweeps farther apart: velocity carries on no longer than this
  bool rotation_guess = true;                 // range-image rotation guess (design 6.3)

  // LiDAR update.
  double range_sigma_m = 0.02;        // of one range, unless the rig file gives lidar0.range_sigma_m
  double bearing_sigma_rad = 0.0005;  // of a beam's direction and spread
  double range_min_m = 0.3;           // nearer returns are the carrier itself
  double range_max_m = 120.0;
  int registration_points = 2500;  // points wanted for the update after spatial down-sampling
  int iterations_max = 15;
  double normal_sigma_rad = 0.05;  // error of the surfaces' normals: sensitivity below its square is no geometry

  double budget_ms = 0;  // of one sweep: beyond, iterations and points are shed; 0: as long as it takes

  VisionConfig vision;
};

}  // namespace lxd
