// SPDX-License-Identifier: Apache-2.0
// How far this odometry drifts, whether it does at all, and how long this receiver's errors last, told from the fixes
// themselves: of some pairs of both, each has its own filter over the path, and what each expected of the next fix says
// how likely it is (multiple-model estimation: Magill 1965; Bar-Shalom, Li & Kirubarajan 2001, section 11.6).
#pragma once

#include <cmath>
#include <optional>
#include <span>

#include "backend/graph/gnss_fix.hpp"
#include "backend/graph/odometry_chain.hpp"

namespace lxd {

// Decisive evidence by Jeffreys' scale (1961): where nothing drifts, about one drive in so many at most is taken for
// one that does, as far as fixes err as is said here.
inline constexpr double kOddsWanted = 100;

struct NoiseLevels {
  // Times what the chain says of odometry's standard deviation: of yaw and level positions, of tilt and height.
  double drift_horizontal = 1, drift_vertical = 1;
  double white_share = 0.1;  // of a fix's variance; the rest lasts
  double correlation_s = 0;  // the time constant of what lasts
  double jitter_s = 0;       // of their stamps
  // How many times likelier the fixes are if odometry drifts than if it does not: the natural logarithm.
  double log_odds_of_drift = 0;

  // Otherwise it may as well be the fixes that err.
  [[nodiscard]] bool drift_shown() const { return log_odds_of_drift > std::log(kOddsWanted); }
};

// The covariance of `motion`, so many times as large. `R_map_a`: up is +z.
Matrix6d scaled(const RelativeMotion& motion, const Eigen::Matrix3d& R_map_a, const NoiseLevels& levels);

// In bounded time, however many fixes there are. `T_enu_world` to within a few degrees; the fixes in order of their key
// frames, with `covariance_m2` as they are weighted; how old they are when they come is known to `delay_sigma_s`. None:
// too few fixes to say.
std::optional<NoiseLevels> find_noise_levels(const OdometryChain& chain, std::span<const GnssMeasurement> fixes,
                                             const Pose& T_enu_world, double delay_s, double delay_sigma_s);

}  // namespace lxd
