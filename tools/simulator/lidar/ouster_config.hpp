// SPDX-License-Identifier: Apache-2.0
// What a scenario says of a simulated Ouster OS0 or OS1.
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

inline constexpr std::array<std::string_view, 2> kOusterProducts{"OS0", "OS1"};
inline constexpr std::array<std::string_view, 3> kOusterSimulatedProfiles{"LEGACY", "RNG19_RFL8_SIG16_NIR16",
                                                                          "RNG15_RFL8_NIR8"};
inline constexpr std::array<std::string_view, 2> kOusterClockSources{"TIME_FROM_INTERNAL_OSC", "TIME_FROM_PTP_1588"};
// Of the sensor's own IMU; NONE: its packets are not recorded.
inline constexpr std::array<std::string_view, 3> kOusterImuProfiles{"NONE", "LEGACY", "ACCEL32_GYRO32_NMEA"};

struct OusterConfig {
  std::string sensor = "lidar0";
  std::string product = "OS1";
  std::uint32_t beams = 64;      // 16, 32, 64, 128
  std::uint32_t columns = 1024;  // a turn: 512, 1024, 2048
  double rate_hz = 10;           // 10, 20
  std::string profile = "RNG19_RFL8_SIG16_NIR16";
  std::string clock_source = "TIME_FROM_INTERNAL_OSC";
  std::string imu = "LEGACY";
  double imu_error_scale = 1;  // of every error of its IMU; 0: none
  std::uint32_t lidar_port = 7502, imu_port = 7503;
  ReturnConfig returns;
  Pose T_body_sensor;
  ClockConfig clock;

  [[nodiscard]] bool own_epoch() const { return clock_source == kOusterClockSources[0]; }
  [[nodiscard]] double column_period_s() const { return 1 / (rate_hz * columns); }
};

// The product's keys first, for its ranges are the defaults of the others.
void read_keys(YamlSection& section, OusterConfig& config);

// What data sheets say of a product's ranges.
ReturnConfig default_returns(std::string_view product);

// The same sensor without any error but the wire's number format.
OusterConfig without_errors(OusterConfig config);

}  // namespace lxd::sim
