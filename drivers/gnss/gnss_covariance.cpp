// SPDX-License-Identifier: Apache-2.0
#include "drivers/gnss/gnss_covariance.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

constexpr double kSmallestSigma_m = 1e-3;  // receivers print 0.0 for less than their last digit
constexpr double kGreatestCorrelation = 0.99;
constexpr double kAlike = 2;
constexpr double kVerticalFactor = 1.5;  // of the horizontal error, where nothing says how high
constexpr double kUsualHdop = 1;

// Standard deviation of one range, by the sort of fix: what receivers' data sheets promise at a DOP of 1.
std::optional<double> range_sigma_m(GnssQuality quality) {
  switch (quality) {
    case GnssQuality::single:
    case GnssQuality::pps:
      return 3.0;
    case GnssQuality::differential:
      return 1.0;
    case GnssQuality::rtk_float:
      return 0.3;
    case GnssQuality::rtk_fixed:
      return 0.02;
    case GnssQuality::dead_reckoning:
      return 10.0;
    default:
      return std::nullopt;
  }
}

double variance_of(double sigma_m) { return std::pow(std::max(sigma_m, kSmallestSigma_m), 2); }

// Of east with north: the ellipse's axes, turned. Bounded, as receivers round their numbers; none where the ellipse is
// not that of the sigmas beside it (a SkyTraq's is of the ranges' errors).
double east_north(const GnssFix& fix, double east_m2, double north_m2) {
  if (!fix.sigma_major_m || !fix.sigma_minor_m || !fix.major_azimuth_rad) return 0;
  const double a = *fix.sigma_major_m, b = *fix.sigma_minor_m, azimuth = *fix.major_azimuth_rad;
  const double of_ellipse_m2 = a * a + b * b, of_sigmas_m2 = east_m2 + north_m2;
  if (of_ellipse_m2 > kAlike * of_sigmas_m2 || of_sigmas_m2 > kAlike * of_ellipse_m2) return 0;
  const double most = kGreatestCorrelation * std::sqrt(east_m2 * north_m2);
  return std::clamp((a * a - b * b) * std::sin(azimuth) * std::cos(azimuth), -most, most);
}

}  // namespace

std::optional<GnssCovariance> covariance_of(const GnssFix& fix) {
  if (!fix.has_position()) return std::nullopt;
  GnssCovariance covariance;
  Eigen::Matrix3d& C = covariance.enu_m2;
  if (fix.sigma_latitude_m && fix.sigma_longitude_m && fix.sigma_altitude_m) {
    C.diagonal() << variance_of(*fix.sigma_longitude_m), variance_of(*fix.sigma_latitude_m),
        variance_of(*fix.sigma_altitude_m);
    C(0, 1) = C(1, 0) = east_north(fix, C(0, 0), C(1, 1));
    covariance.said = true;
    return covariance;
  }
  const auto range_m = range_sigma_m(fix.quality);
  if (!range_m) return std::nullopt;
  const double hdop = fix.hdop.value_or(kUsualHdop), vdop = fix.vdop.value_or(kVerticalFactor * hdop);
  const double horizontal_m2 = variance_of(*range_m * hdop) / 2;  // HDOP is of both directions together
  C.diagonal() << horizontal_m2, horizontal_m2, variance_of(*range_m * vdop);
  return covariance;
}

}  // namespace lxd
