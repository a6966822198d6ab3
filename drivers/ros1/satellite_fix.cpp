// SPDX-License-Identifier: Apache-2.0
#include "drivers/ros1/satellite_fix.hpp"

#include <array>
#include <cmath>

namespace lxd {
namespace {

// NavSatStatus.status: -1 no fix, 0 fix, 1 satellite-based, 2 ground-based augmentation. The last stands for a float as
// well as for a fixed solution: the covariance, not this, says how good it is.
GnssQuality quality_of(std::int8_t status) {
  if (status < 0) return GnssQuality::none;
  if (status == 0) return GnssQuality::single;
  return status == 1 ? GnssQuality::differential : GnssQuality::rtk_float;
}

constexpr double kHighestLatitude_deg = 90, kHighestLongitude_deg = 180;
constexpr double kHighest_m = 1e6;

bool is_place(double latitude_deg, double longitude_deg, double height_m) {
  return std::abs(latitude_deg) <= kHighestLatitude_deg && std::abs(longitude_deg) <= kHighestLongitude_deg &&
         std::abs(height_m) <= kHighest_m;
}

// east, north, up, row by row, m^2; a type of 0: unknown.
void take_covariance(const std::array<double, 9>& covariance, std::uint8_t type, GnssFix& fix) {
  const auto is_variance = [](double value) { return value > 0 && std::isfinite(value); };
  if (type == 0 || !is_variance(covariance[0]) || !is_variance(covariance[4]) || !is_variance(covariance[8])) return;
  fix.sigma_longitude_m = std::sqrt(covariance[0]);
  fix.sigma_latitude_m = std::sqrt(covariance[4]);
  fix.sigma_altitude_m = std::sqrt(covariance[8]);
}

}  // namespace

Ros1Fault read_ros1_satellite_fix(Ros1Reader::Bytes message, Ros1SatelliteFix& out) {
  Ros1Reader reader(message);
  out.header = read_ros1_header(reader);
  out.fix = {};
  out.fix.quality = quality_of(reader.number<std::int8_t>());
  (void)reader.number<std::uint16_t>();  // which satellites
  const double latitude_deg = reader.number<double>();
  const double longitude_deg = reader.number<double>();
  const double height_m = reader.number<double>();
  std::array<double, 9> covariance{};
  for (double& element : covariance) element = reader.number<double>();
  const auto type = reader.number<std::uint8_t>();
  if (const Ros1Fault fault = reader.finish(); fault != Ros1Fault::none) return fault;
  if (out.fix.quality == GnssQuality::none) return Ros1Fault::none;  // what it says besides has no meaning
  if (!is_place(latitude_deg, longitude_deg, height_m)) return Ros1Fault::non_finite;
  out.fix.latitude_deg = latitude_deg;
  out.fix.longitude_deg = longitude_deg;
  out.fix.altitude_msl_m = height_m;
  out.fix.geoid_m = 0;  // so that their sum is what the message says
  take_covariance(covariance, type, out.fix);
  return Ros1Fault::none;
}

Ros1Fault read_ros1_sentence(Ros1Reader::Bytes message, Ros1Sentence& out) {
  Ros1Reader reader(message);
  out.header = read_ros1_header(reader);
  out.text = reader.text();
  if (const Ros1Fault fault = reader.finish(); fault != Ros1Fault::none) return fault;
  return out.text.empty() ? Ros1Fault::empty : Ros1Fault::none;
}

}  // namespace lxd
