// SPDX-License-Identifier: Apache-2.0
#include "estimator/degeneracy.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace lxd {
namespace {

// Turns rotation into metres at the typical lever arm, so that the six directions compare.
Vector6d scaling(double lever_m) {
  Vector6d d;
  d << Eigen::Vector3d::Constant(1.0 / lever_m), Eigen::Vector3d::Ones();
  return d;
}

}  // namespace

Degeneracy find_degeneracy(const NormalEquations& sums, double threshold) {
  Degeneracy out;
  if (!(sums.weight > 0)) {
    out.directions = 6;
    return out;
  }
  const Matrix6d pose = sums.information.topLeftCorner<6, 6>();
  const double turn = pose.topLeftCorner<3, 3>().trace(), shift = pose.bottomRightCorner<3, 3>().trace();
  out.lever_m = std::sqrt(std::max(turn, 1e-9) / std::max(shift, 1e-9));
  const Vector6d d = scaling(out.lever_m);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(d.asDiagonal() * pose * d.asDiagonal() / sums.weight);
  out.axes = solver.eigenvectors();
  out.sensitivity = solver.eigenvalues();
  while (out.directions < 6 && out.sensitivity[out.directions] < threshold) ++out.directions;
  return out;
}

void project_out(const Degeneracy& degeneracy, NormalEquations& sums) {
  if (degeneracy.directions == 0) return;
  Matrix6d keep = Matrix6d::Identity();
  for (int i = 0; i < degeneracy.directions; ++i) keep -= degeneracy.axes.col(i) * degeneracy.axes.col(i).transpose();
  const Vector6d d = scaling(degeneracy.lever_m);
  const Matrix6d M = d.cwiseInverse().asDiagonal() * keep * d.asDiagonal();
  // The rates are held along the directions along which the pose is: v like p, and b_g, minus the rate, like theta.
  LidarMatrix project = LidarMatrix::Zero();
  project.topLeftCorner<6, 6>() = M;
  project.block<3, 3>(kVelocity, kVelocity) = M.block<3, 3>(kPosition, kPosition);
  project.block<3, 3>(kVelocity, kGyroBias) = -M.block<3, 3>(kPosition, kTheta);
  project.block<3, 3>(kGyroBias, kVelocity) = -M.block<3, 3>(kTheta, kPosition);
  project.block<3, 3>(kGyroBias, kGyroBias) = M.block<3, 3>(kTheta, kTheta);
  sums.information = (project * sums.information * project.transpose()).eval();
  sums.gradient = (project * sums.gradient).eval();
}

}  // namespace lxd
