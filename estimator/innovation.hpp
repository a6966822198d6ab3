// SPDX-License-Identifier: Apache-2.0
// Was the update's correction as large as the filter expected: the normalised innovation squared (NIS; Bar-Shalom, Li,
// Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, section 5.4) of a sweep of thousands of
// residuals, told by what they add up to.
//
// With the prior's information L = P^-1, the measurement's A = H^T W H and z = -A^+ H^T W r, what the residuals say of
// the state, the innovation z has the covariance P + A^+, and the correction is dx = (L + A)^-1 A z. Along the
// generalised eigenvectors of A v = m L v, scaled so that v^T L v = 1, the corrections y = v^T L dx are independent and
// have the variance m / (1 + m): the NIS is the sum of y^2 (1 + m) / m. It is chi^2 distributed with as many degrees of
// freedom as there are directions, and equals r^T (H P H^T + R)^-1 r of the residuals' share that the state explains.
#pragma once

#include "estimator/point_to_mesh.hpp"

namespace lxd {

struct Innovation {
  double squared = 0;  // NIS; `dimensions` on average when prior and measurement are as sure as they should be
  int dimensions = 0;  // 0: no update

  [[nodiscard]] double per_dimension() const { return dimensions > 0 ? squared / dimensions : 0; }
};

// Directions in which the measurement knows less than this share of what the prior knows are left out: the update says
// nothing of them. Whether one counts does not depend on the correction, so that the NIS stays unbiased.
inline constexpr double kInformativeShare = 0.1;

// Both informations at the prior, of [theta, p, v, b_g]; correction: posterior [-] prior. No dimensions when the prior
// is not positive definite or a number is not finite.
Innovation innovation(const LidarMatrix& prior_information, const LidarMatrix& measured_information,
                      const LidarVector& correction);

}  // namespace lxd
