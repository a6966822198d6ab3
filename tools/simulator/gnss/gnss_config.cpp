// SPDX-License-Identifier: Apache-2.0
// See gnss_config.hpp.
#include "tools/simulator/gnss/gnss_config.hpp"

#include <array>
#include <cmath>

namespace lxd::sim {
namespace {

constexpr ValueRange kRate{0.1, 50, "Hz", ""};
constexpr ValueRange kLatitude{-89, 89, "degrees", ""};  // closer to a pole east and north swing round
constexpr ValueRange kLongitude{-180, 180, "degrees", ""};
constexpr ValueRange kHeight{-1000, 10'000, "m", ""};
constexpr ValueRange kYaw{-7, 7, "rad", "is it in degrees?"};
constexpr ValueRange kLever{-100, 100, "m", "is it in millimetres?"};
constexpr ValueRange kSigma{0, 100, "m", ""};
constexpr ValueRange kFactor{0, 10, "", ""};
constexpr ValueRange kPart{0, 1, "", "is it in per cent?"};
constexpr ValueRange kTime{0.01, 10'000, "s", ""};
constexpr ValueRange kTimeOrNone{0, 10'000, "s", ""};
constexpr ValueRange kSpeedSigma{0, 10, "m/s", ""};
constexpr ValueRange kSatellites{4, 60, "", ""};
constexpr ValueRange kMask{0, 60, "degrees", ""};
constexpr ValueRange kPerHour{0, 3600, "an hour", ""};
constexpr ValueRange kProcessing{0, 1, "s", "is it in milliseconds?"};
constexpr ValueRange kBaud{4800, 921'600, "baud", ""};

void read_errors(YamlSection& section, GnssConfig& config) {
  section.read("sigma_single_m", config.sigma_single_m, kSigma);
  section.read("sigma_float_m", config.sigma_float_m, kSigma);
  section.read("sigma_fixed_m", config.sigma_fixed_m, kSigma);
  section.read("vertical_factor", config.vertical_factor, kFactor);
  section.read("white_part", config.white_part, kPart);
  section.read("correlation_time_s", config.correlation_time_s, kTime);
  section.read("speed_sigma_mps", config.speed_sigma_mps, kSpeedSigma);
  section.read("multipath_m", config.multipath_m, kSigma);
  section.read("multipath_time_s", config.multipath_time_s, kTime);
}

void read_sky(YamlSection& section, GnssConfig& config) {
  section.read("satellites", config.satellites, kSatellites);
  section.read("mask_deg", config.mask_deg, kMask);
  section.read("blocked_no_fix", config.blocked_no_fix, kPart);
  section.read("blocked_no_rtk", config.blocked_no_rtk, kPart);
  section.read("reacquire_s", config.reacquire_s, kTimeOrNone);
  section.read("rtk", config.rtk);
  section.read("rtk_fix_s", config.rtk_fix_s, kTimeOrNone);
  section.read("rtk_losses_per_hour", config.rtk_losses_per_hour, kPerHour);
}

}  // namespace

void read_keys(YamlSection& section, GnssConfig& config) {
  constexpr double kMillis = 1000;
  section.read("rate_hz", config.rate_hz, kRate);
  const double period_ms = kMillis / config.rate_hz;
  if (std::abs(period_ms - std::round(period_ms)) > 1e-9)
    section.complain("rate_hz", "found a period that is not whole milliseconds, wanted one that is");
  section.read("origin_latitude_deg", config.origin.latitude_deg, kLatitude);
  section.read("origin_longitude_deg", config.origin.longitude_deg, kLongitude);
  section.read("origin_height_m", config.origin.height_m, kHeight);
  section.read("enu_yaw_rad", config.enu_yaw_rad, kYaw);
  section.read("geoid_m", config.geoid_m, kHeight);
  if (const auto antenna = section.read_numbers("antenna_in_reference_m", 3, kLever))
    config.antenna_in_reference_m = {(*antenna)[0], (*antenna)[1], (*antenna)[2]};
  read_errors(section, config);
  read_sky(section, config);
  section.read("processing_s", config.processing_s, kProcessing);
  section.read("baud_rate", config.baud_rate, kBaud);
}

}  // namespace lxd::sim
