// SPDX-License-Identifier: Apache-2.0
// What a scenario says of the GNSS receiver.
#pragma once

#include "board/yaml_section.hpp"
#include "drivers/gnss/enu.hpp"
#include "rt/pose.hpp"
#include "tools/simulator/clock.hpp"

namespace lxd::sim {

struct GnssConfig {
  double rate_hz = 5;                     // whole milliseconds a period
  Geodetic origin{47.3769, 8.5417, 470};  // of the world's origin
  double enu_yaw_rad = 0;                 // from the world's x to east: R_enu_world = Rz(enu_yaw)
  double geoid_m = 47.5;                  // above the ellipsoid, everywhere
  Eigen::Vector3d antenna_in_reference_m = Eigen::Vector3d::Zero();

  // Standard deviations of each horizontal axis under an open sky; the vertical one is vertical_factor times as large.
  double sigma_single_m = 1.2, sigma_float_m = 0.25, sigma_fixed_m = 0.012;
  double vertical_factor = 1.8;
  double white_part = 0.1;         // of the standard deviation; the rest is correlated
  double correlation_time_s = 40;  // Gauss-Markov
  double speed_sigma_mps = 0.03;

  double multipath_m = 4;  // added when the whole sky is blocked; in proportion to what is
  double multipath_time_s = 12;
  double satellites = 22;       // in view under an open sky
  double mask_deg = 10;         // lower ones are not used
  double blocked_no_fix = 0.8;  // parts of the sky
  double blocked_no_rtk = 0.45;
  double reacquire_s = 3;  // from sight to fix after an outage

  bool rtk = true;
  double rtk_fix_s = 12;           // from float to fixed
  double rtk_losses_per_hour = 6;  // for no reason that is simulated

  double processing_s = 0.05;  // from the epoch to the first byte
  double baud_rate = 115200;
  ClockConfig clock;  // offset and skew: UTC against the host's clock; jitter_s is not used
};

void read_keys(YamlSection& section, GnssConfig& config);

}  // namespace lxd::sim
