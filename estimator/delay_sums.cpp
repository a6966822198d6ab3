// SPDX-License-Identifier: Apache-2.0
#include "estimator/delay_sums.hpp"

#include <Eigen/Cholesky>

#include "estimator/rate_information.hpp"

namespace lxd {

DelaySums delay_sums(std::span<const PointResidual> residuals, std::span<const RegistrationPoint> points,
                     const SweepPath& path, const RobustWeight& weight) {
  DelaySums sums;
  for (const PointResidual& residual : residuals) {
    const RegistrationPoint& point = points[residual.point];
    const double c =
        row_by_delay(path.nearest_knot(point.offset_ns), point.p_body_m, residual.row.segment<3>(kPosition));
    const double weighted = weight.of(residual) * c;
    sums.coupling += weighted * residual.row;
    sums.information += weighted * c;
    sums.gradient += weighted * residual.r_m;
  }
  return sums;
}

void limit(std::size_t rows, const LidarMatrix& measured, const Vector6d& pose_gradient, DelaySums& sums) {
  const double doubted = doubted_share(rows);
  const Eigen::LLT<Matrix6d> held(measured.topLeftCorner<6, 6>());
  if (held.info() != Eigen::Success) {
    sums = {};
    return;
  }
  const Vector6d pose = held.solve(sums.coupling.head<6>());  // how it gives way to the delay
  const Vector6d rates = measured.bottomLeftCorner<6, 6>() * pose;
  sums.information += doubted * (sums.coupling.head<6>().dot(pose) - sums.information);
  sums.gradient += doubted * (pose.dot(pose_gradient) - sums.gradient);
  sums.coupling.tail<6>() += doubted * (rates - sums.coupling.tail<6>());
}

}  // namespace lxd
