// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/livox_config.hpp"

namespace lxd::sim {
namespace {

constexpr ValueRange kScale{0, 100, "", ""};

}  // namespace

void read_keys(YamlSection& section, LivoxConfig& config) {
  section.read("clock_source", config.clock_source, kLivoxClockSources);
  section.read("imu", config.imu);
  section.read("imu_error_scale", config.imu_error_scale, kScale);
  read_keys(section, config.returns);
}

LivoxConfig without_errors(LivoxConfig config) {
  config.returns = without_errors(config.returns);
  config.imu_error_scale = 0;
  config.clock = {};
  return config;
}

}  // namespace lxd::sim
