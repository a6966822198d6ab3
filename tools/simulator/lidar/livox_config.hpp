// SPDX-License-Identifier: Apache-2.0
// What a scenario says of a simulated Livox Mid-360.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "board/yaml_section.hpp"
#include "rt/pose.hpp"
#include "tools/simulator/clock.hpp"
#include "tools/simulator/lidar/return_model.hpp"

namespace lxd::sim {

inline constexpr std::array<std::string_view, 3> kLivoxClockSources{"NONE", "PTP", "GPS"};  // as time_type 0, 1, 2

// Livox' data sheet: 40 m at 10 % reflectivity, 70 m at 80 %, 0.1 m blind zone, 2 cm of noise at 10 m.
inline constexpr ReturnConfig kMid360Returns{
    .range_min_m = 0.1, .range_max_m = 70, .range_sigma_m = 0.01, .detection_range_m = 40};

struct LivoxConfig {
  std::string sensor = "lidar0";
  std::string clock_source = "NONE";  // NONE: its own clock, since it was switched on
  bool imu = true;                    // false: its IMU's packets are not recorded
  double imu_error_scale = 1;         // of every error of its IMU; 0: none
  ReturnConfig returns = kMid360Returns;
  Pose T_body_sensor;
  ClockConfig clock;

  [[nodiscard]] bool own_epoch() const { return clock_source == kLivoxClockSources[0]; }
};

void read_keys(YamlSection& section, LivoxConfig& config);

// The same sensor without any error but the wire's number format.
LivoxConfig without_errors(LivoxConfig config);

}  // namespace lxd::sim
