// SPDX-License-Identifier: Apache-2.0
// What a user may set of the factor graph. All else is named where it is used.
#pragma once

namespace lxd {

struct GraphConfig {
  // A key frame is cut after so much way, turn or time, whichever comes first.
  double key_frame_distance_m = 2;
  double key_frame_turn_rad = 0.35;
  double key_frame_time_s = 5;

  // The least that odometry drifts: random walks, added to the filter's own covariance. That one says how well a sweep
  // fits the map; that the map itself was built along the way and errs with it, it does not know.
  double drift_m_per_sqrt_m = 0.01;
  double drift_rad_per_sqrt_m = 1e-4;
  double drift_rad_per_sqrt_rad = 1e-3;

  double tilt_sigma_rad = 5e-3;  // of "up" as an IMU feels it: a bias of 0.05 m/s^2

  // A loop closes no better than this, whatever its covariance says.
  double loop_sigma_m = 0.03;
  double loop_sigma_rad = 2e-3;
  int loop_agreeing_min = 2;  // loops that must agree before any of them closes

  double gnss_sigma_min_m = 0.01;  // a receiver is no better than this, whatever it says
  double gnss_correlation_s = 60;  // over which its errors are alike, until they tell: atmosphere, orbits, reflections
  double gnss_delay_s = 0.05;      // of a fix against its stamp, expected; the graph estimates it
  double gnss_delay_sigma_s = 0.05;
  double correction_time_s = 1;  // over which T_map_world follows the graph
  int work_per_key_frame = 40;   // poses that may be solved for each key frame, on average
};

}  // namespace lxd
