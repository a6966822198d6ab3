// SPDX-License-Identifier: Apache-2.0
#include "estimator/degeneracy.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace lxd {
namespace {

constexpr double kHeldTrust = 0.5;
constexpr double kRoundingNoise = 1e-12;  // sensitivity that float normals and sums give where there is none

// Turns rotation into metres at the typical lever arm, so that the six directions compare.
Vector6d scaling(double lever_m) {
  Vector6d d;
  d << Eigen::Vector3d::Constant(1.0 / lever_m), Eigen::Vector3d::Ones();
  return d;
}

}  // namespace

Degeneracy find_degeneracy(const NormalEquations& sums, double noise) {
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
  const double floor = std::max(noise, kRoundingNoise);
  out.trust = (1.0 - floor * out.sensitivity.array().max(floor).inverse()).max(0.0).matrix();
  while (out.directions < 6 && out.trust[out.directions] < kHeldTrust) ++out.directions;
  return out;
}

void discount(const Degeneracy& degeneracy, NormalEquations& sums) {
  const Matrix6d keep = degeneracy.axes * degeneracy.trust.cwiseSqrt().asDiagonal() * degeneracy.axes.transpose();
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
  sums.gradient = (project * (project * sums.gradient)).eval();
}

}  // namespace lxd
