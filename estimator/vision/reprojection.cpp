// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/reprojection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace lxd {
namespace {

constexpr double kMedianSquaredRatio = 2 * std::numbers::ln2;  // of chi^2 with two degrees of freedom

}  // namespace

bool reproject(const VisualObservation& observation, const PathKnot& knot, const MountedCamera& camera,
               double pixel_sigma_px, VisualResidual& residual) noexcept {
  const Eigen::Matrix3d R_body_world = knot.R.transpose(), R_camera_body = camera.T_body_camera.R.transpose();
  const Eigen::Vector3d p_body = R_body_world * (observation.p_world_m - knot.p);
  Eigen::Vector2d pixel;
  ProjectionJacobian J;
  if (!camera.model.project(R_camera_body * (p_body - camera.T_body_camera.p), pixel, &J)) return false;
  const Eigen::Matrix<double, 2, 3> by_body = J * R_camera_body, by_world = by_body * R_body_world;
  residual.r_px = pixel - observation.pixel;
  residual.covariance_px2 = pixel_sigma_px * pixel_sigma_px * Eigen::Matrix2d::Identity() +
                            by_world * observation.covariance_m2 * by_world.transpose();
  for (int k = 0; k < 2; ++k) residual.rows.row(k) = -row_along(knot, p_body, by_world.row(k).transpose());
  return residual.r_px.allFinite() && residual.covariance_px2.allFinite() && residual.rows.allFinite();
}

double squared_ratio(const VisualResidual& residual) {
  return residual.r_px.dot(residual.covariance_px2.inverse() * residual.r_px);
}

double visual_scale(std::span<const VisualResidual> residuals, std::span<float> scratch) {
  if (residuals.empty()) return 1.0;
  const auto ratios = scratch.first(residuals.size());
  for (std::size_t i = 0; i < residuals.size(); ++i) ratios[i] = static_cast<float>(squared_ratio(residuals[i]));
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return std::sqrt(std::max(1.0, static_cast<double>(*middle) / kMedianSquaredRatio));
}

NormalEquations accumulate(std::span<const VisualResidual> residuals, double scale, double kernel_sigmas) {
  NormalEquations sums;
  for (const VisualResidual& residual : residuals) {
    const Eigen::LLT<Eigen::Matrix2d> root(scale * scale * residual.covariance_px2);
    const Eigen::Vector2d r = root.matrixL().solve(residual.r_px);
    const Eigen::Matrix<double, 2, kLidarDim> H = root.matrixL().solve(residual.rows);
    const double w = geman_mcclure(r.squaredNorm(), kernel_sigmas * kernel_sigmas);
    sums.information.noalias() += w * H.transpose() * H;
    sums.gradient.noalias() += w * H.transpose() * r;
    sums.weight += w * H.middleCols<3>(kPosition).squaredNorm();
  }
  return sums;
}

// Were the body moved by (dtheta, dp) then, the rows would say so with their columns of the pose. Of that error's
// covariance S S, S (1 + S A S)^-1 S is what is left when the image has told it, A = H^T W H of the pose.
void marginalise(const Vector6d& pose_variance, NormalEquations& sums) {
  const Vector6d S = pose_variance.cwiseSqrt();
  const Matrix6d told = S.asDiagonal() * sums.information.topLeftCorner<6, 6>() * S.asDiagonal();
  const Eigen::LLT<Matrix6d> factors(Matrix6d::Identity() + told);
  const Eigen::Matrix<double, 6, kLidarDim> rows = S.asDiagonal() * sums.information.topRows<6>();
  const Vector6d pull = S.asDiagonal() * sums.gradient.head<6>();
  sums.gradient.noalias() -= rows.transpose() * factors.solve(pull);
  sums.information.noalias() -= rows.transpose() * factors.solve(rows);
  sums.weight = sums.information.diagonal().segment<3>(kPosition).sum();
}

NormalEquations& operator+=(NormalEquations& sums, const NormalEquations& others) {
  sums.information += others.information;
  sums.gradient += others.gradient;
  sums.weight += others.weight;
  return sums;
}

}  // namespace lxd
