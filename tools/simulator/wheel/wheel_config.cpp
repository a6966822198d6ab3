// SPDX-License-Identifier: Apache-2.0
// See wheel_config.hpp.
#include "tools/simulator/wheel/wheel_config.hpp"

#include <array>

namespace lxd::sim {
namespace {

constexpr ValueRange kRate{1, 200, "Hz", ""};
constexpr ValueRange kLength{0.05, 10, "m", "is it in millimetres?"};
constexpr ValueRange kRadius{0.01, 2, "m", "is it in millimetres?"};
constexpr ValueRange kScaleError{-0.5, 0.5, "", "is it in per cent?"};
constexpr ValueRange kSpeedSigma{0, 5, "m/s", ""};
constexpr ValueRange kPerMinute{0, 600, "a minute", ""};
constexpr ValueRange kSlipTime{0.01, 60, "s", "is it in milliseconds?"};
constexpr ValueRange kSlipPart{-1, 5, "", "is it in per cent?"};
constexpr ValueRange kOtherRate{0, 5000, "Hz", ""};
constexpr ValueRange kOdometer{-2147483648.0, 2147483647.0, "mm", ""};
constexpr std::array<std::string_view, 2> kProtocols{"agilex", "toyota"};

}  // namespace

void read_keys(YamlSection& section, WheelConfig& config) {
  std::string protocol(kProtocols[static_cast<std::size_t>(config.protocol)]);
  section.read("protocol", protocol, kProtocols);
  config.protocol = protocol == kProtocols[0] ? WheelProtocol::agilex : WheelProtocol::toyota;
  section.read("rate_hz", config.rate_hz, kRate);
  section.read("track_m", config.track_m, kLength);
  section.read("wheelbase_m", config.wheelbase_m, kLength);
  section.read("wheel_radius_m", config.wheel_radius_m, kRadius);
  section.read("scale_error", config.scale_error, kScaleError);
  section.read("speed_sigma_mps", config.speed_sigma_mps, kSpeedSigma);
  section.read("slip_per_minute", config.slip_per_minute, kPerMinute);
  section.read("slip_s", config.slip_s, kSlipTime);
  section.read("slip_part", config.slip_part, kSlipPart);
  section.read("other_frames_hz", config.other_frames_hz, kOtherRate);
  section.read("odometer_start_mm", config.odometer_start_mm, kOdometer);
  section.read("csv", config.csv);
  section.read("interface", config.interface);
  if (config.interface.empty() || config.interface.find_first_of(" \t#") != std::string::npos)
    section.complain("interface", "found '" + config.interface + "', wanted the name of a network interface");
}

}  // namespace lxd::sim
