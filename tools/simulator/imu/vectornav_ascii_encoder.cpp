// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/vectornav_ascii_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace lxd::sim {
namespace {

double within(double value, double most) { return std::isnan(value) ? -most : std::clamp(value, -most, most); }

}  // namespace

std::vector<std::uint8_t> vectornav_line(std::string_view body) {
  const std::string line = fmt::format("${}*{:02X}\r\n", body, vectornav_ascii_checksum(body));
  return {line.begin(), line.end()};
}

std::vector<std::uint8_t> encode_vectornav_line(const Inertial& sample) {
  constexpr double kAccelMax_mps2 = 999.999, kRateMax_radps = 99.999999;
  std::string body = "VNIMU,+00.0000,+00.0000,+00.0000";
  for (int i = 0; i < 3; ++i) body += fmt::format(",{:+08.3f}", within(sample.accel_mps2[i], kAccelMax_mps2));
  for (int i = 0; i < 3; ++i) body += fmt::format(",{:+010.6f}", within(sample.gyro_radps[i], kRateMax_radps));
  return vectornav_line(body + ",+25.0,+101.325");
}

}  // namespace lxd::sim
