// SPDX-License-Identifier: Apache-2.0
// What a sweep's own skew says of the IMU's delay: its returns are put along the readings, and those come late.
#pragma once

#include <span>

#include "estimator/normal_equations.hpp"

namespace lxd {

// With c = dr / d delay and the state held: sums over the residuals.
struct DelaySums {
  LidarVector coupling = LidarVector::Zero();  // H^T W c
  double information = 0;                      // c^T W c, 1/s^2
  double gradient = 0;                         // c^T W r, 1/s
};

// Of the residuals as accumulate() weighs them.
DelaySums delay_sums(std::span<const PointResidual> residuals, std::span<const RegistrationPoint> points,
                     const SweepPath& path, const RobustWeight& weight);

// The same doubt in what skew tells as limit_rates() has: of c beyond the pose. measured: of the same residuals,
// limited. pose_gradient: H^T W r of the pose's rows.
void limit(std::size_t rows, const LidarMatrix& measured, const Vector6d& pose_gradient, DelaySums& sums);

}  // namespace lxd
