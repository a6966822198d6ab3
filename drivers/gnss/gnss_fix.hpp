// SPDX-License-Identifier: Apache-2.0
// What a GNSS receiver says of one epoch. Every part may be missing: what a receiver leaves empty is unknown, never 0.
#pragma once

#include <cstdint>
#include <optional>

#include "rt/time.hpp"

namespace lxd {

// Field 6 of GGA.
enum class GnssQuality : std::uint8_t {
  none = 0,
  single = 1,
  differential = 2,
  pps = 3,
  rtk_fixed = 4,
  rtk_float = 5,
  dead_reckoning = 6,
  manual = 7,
  simulator = 8
};

// Latitude and longitude stay in degrees, as on the wire and in GeographicLib: turning them to radians and back costs
// digits and helps nobody.
struct GnssFix {
  RigTime received;                    // of the first byte of the epoch's first sentence
  std::int64_t time_of_day_ns = 0;     // UTC; 23:59:60 is 86400 s
  std::optional<std::int64_t> utc_ns;  // unix time; unknown until a sentence has said the date
  GnssQuality quality = GnssQuality::none;
  bool warned = false;  // RMC says V: the receiver itself does not trust it
  std::optional<double> latitude_deg, longitude_deg;
  std::optional<double> altitude_msl_m, geoid_m;
  std::optional<double> sigma_latitude_m, sigma_longitude_m, sigma_altitude_m;
  // Of the ellipse of horizontal errors, its greater axis clockwise from true north.
  std::optional<double> sigma_major_m, sigma_minor_m, major_azimuth_rad;
  std::optional<double> hdop, pdop, vdop;
  std::optional<double> speed_mps, course_rad;  // over ground; course clockwise from true north
  std::optional<double> correction_age_s;
  std::optional<std::uint32_t> satellites;

  // A position that the receiver stands by.
  [[nodiscard]] bool has_position() const {
    return quality != GnssQuality::none && !warned && latitude_deg && longitude_deg;
  }
  // Above the WGS-84 ellipsoid; unknown without the geoid's height.
  [[nodiscard]] std::optional<double> ellipsoid_height_m() const {
    if (!altitude_msl_m || !geoid_m) return std::nullopt;
    return *altitude_msl_m + *geoid_m;
  }
};

}  // namespace lxd
