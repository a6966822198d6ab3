// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/ouster_config.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lxd::sim {
namespace {

constexpr ValueRange kBeams{16, 128, "beams", ""};
constexpr ValueRange kColumns{512, 2048, "columns a turn", ""};
constexpr ValueRange kRate{10, 20, "Hz", "is it in turns a minute?"};
constexpr ValueRange kPort{1, 65535, "", ""};
constexpr ValueRange kScale{0, 100, "", ""};

constexpr std::array kBeamCounts{16U, 32U, 64U, 128U};
constexpr std::array kModes{std::string_view("512x10"), std::string_view("512x20"), std::string_view("1024x10"),
                            std::string_view("1024x20"), std::string_view("2048x10")};

template <typename Values, typename Value>
bool contains(const Values& values, const Value& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

}  // namespace

// Data sheets of revision 6: OS0 15-20 m, OS1 45-60 m at 10 % reflectivity; 75 m and 150 m at 80 % and above.
ReturnConfig default_returns(std::string_view product) {
  ReturnConfig config;
  if (product == "OS0") {
    config.range_min_m = 0.3;
    config.range_max_m = 75;
    config.range_sigma_m = 0.015;
    config.detection_range_m = 20;
  }
  return config;
}

void read_keys(YamlSection& section, OusterConfig& config) {
  section.read("product", config.product, kOusterProducts);
  config.returns = default_returns(config.product);
  section.read("beams", config.beams, kBeams);
  if (!contains(kBeamCounts, config.beams)) section.complain("beams", "wanted 16, 32, 64 or 128");
  section.read("columns", config.columns, kColumns);
  section.read("rate_hz", config.rate_hz, kRate);
  const std::string mode = fmt::format("{}x{}", config.columns, config.rate_hz);
  if (!contains(kModes, mode)) {
    section.complain("columns",
                     fmt::format("found {} (columns x rate_hz), wanted one of {}", mode, fmt::join(kModes, ", ")));
  }
  section.read("profile", config.profile, kOusterSimulatedProfiles);
  section.read("clock_source", config.clock_source, kOusterClockSources);
  section.read("imu", config.imu, kOusterImuProfiles);
  if (config.profile == "LEGACY" && config.imu == "ACCEL32_GYRO32_NMEA") {
    section.complain("imu", "found ACCEL32_GYRO32_NMEA, wanted LEGACY or NONE with the LEGACY profile of points");
  }
  section.read("imu_error_scale", config.imu_error_scale, kScale);
  section.read("lidar_port", config.lidar_port, kPort);
  section.read("imu_port", config.imu_port, kPort);
  read_keys(section, config.returns);
}

OusterConfig without_errors(OusterConfig config) {
  config.returns = without_errors(config.returns);
  config.imu_error_scale = 0;
  config.clock = {};
  return config;
}

}  // namespace lxd::sim
