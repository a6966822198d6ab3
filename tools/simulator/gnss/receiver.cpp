// SPDX-License-Identifier: Apache-2.0
// See receiver.hpp.
#include "tools/simulator/gnss/receiver.hpp"

#include <algorithm>
#include <cmath>

namespace lxd::sim {
namespace {

constexpr double kOpenHdop = 0.6;
// Carrier phases err by reflections of a few centimetres at most, where codes err by metres.
constexpr double kCarrierMultipath = 0.01;
constexpr double kFloatMultipath = 0.15;
// Receivers know little of their reflections.
constexpr double kMultipathReported = 0.5;
constexpr double kHour_s = 3600;

double multipath_part(GnssQuality quality) {
  if (quality == GnssQuality::rtk_fixed) return kCarrierMultipath;
  return quality == GnssQuality::rtk_float ? kFloatMultipath : 1;
}

}  // namespace

// Fewer satellites, and those on one side: the square root is for their number, the rest for the side.
double hdop(double blocked) { return kOpenHdop / std::max(0.05, 1 - blocked); }

GnssQuality FixState::step(double t_s, double blocked, bool lost, bool rtk_lost) {
  const double since_s = t_s - last_s_;
  last_s_ = t_s;
  if (lost || blocked >= config_.blocked_no_fix) fix_from_s_ = t_s + config_.reacquire_s;
  const bool slips = random_.chance(config_.rtk_losses_per_hour / kHour_s * since_s);
  const bool no_fixed = t_s < fix_from_s_ || blocked >= config_.blocked_no_rtk || rtk_lost || slips;
  if (no_fixed) fixed_from_s_ = t_s + config_.rtk_fix_s;
  // With the times at zero (a receiver that is never slow) the condition itself must hold.
  if (t_s < fix_from_s_ || lost || blocked >= config_.blocked_no_fix) return GnssQuality::none;
  if (!config_.rtk || rtk_lost) return GnssQuality::single;
  return no_fixed || t_s < fixed_from_s_ ? GnssQuality::rtk_float : GnssQuality::rtk_fixed;
}

GaussMarkov::GaussMarkov(std::uint64_t seed, std::string_view stream, double time_s)
    : random_(seed, stream), time_s_(time_s), value_(random_.normal()) {}

double GaussMarkov::step(double since_s) {
  const double kept = std::exp(-since_s / time_s_);
  value_ = kept * value_ + std::sqrt(1 - kept * kept) * random_.normal();
  return value_;
}

GnssErrors::GnssErrors(const GnssConfig& config, std::uint64_t seed)
    : config_(config),
      white_(seed, "gnss_white"),
      slow_{GaussMarkov(seed, "gnss_east", config.correlation_time_s),
            GaussMarkov(seed, "gnss_north", config.correlation_time_s),
            GaussMarkov(seed, "gnss_up", config.correlation_time_s)},
      multipath_{GaussMarkov(seed, "gnss_multipath_east", config.multipath_time_s),
                 GaussMarkov(seed, "gnss_multipath_north", config.multipath_time_s),
                 GaussMarkov(seed, "gnss_multipath_up", config.multipath_time_s)} {}

GnssError GnssErrors::step(double t_s, GnssQuality quality, double blocked) {
  const double since_s = t_s - last_s_;
  last_s_ = t_s;
  const double correlated = std::sqrt(1 - config_.white_part * config_.white_part);
  GnssError error;
  for (int axis = 0; axis < 3; ++axis) {
    const double factor = axis == 2 ? config_.vertical_factor : 1;
    const double sigma = factor * sigma_m(quality) * hdop(blocked) / kOpenHdop;
    const double reflected = factor * config_.multipath_m * blocked * multipath_part(quality);
    const double slow = slow_[axis].step(since_s), bounce = multipath_[axis].step(since_s);
    const double white = white_.normal();
    if (quality == GnssQuality::none) continue;
    error.error_m[axis] = sigma * (correlated * slow + config_.white_part * white) + reflected * bounce;
    error.reported_sigma_m[axis] = std::hypot(sigma, kMultipathReported * reflected);
  }
  return error;
}

double GnssErrors::sigma_m(GnssQuality quality) const {
  if (quality == GnssQuality::rtk_fixed) return config_.sigma_fixed_m;
  return quality == GnssQuality::rtk_float ? config_.sigma_float_m : config_.sigma_single_m;
}

}  // namespace lxd::sim
