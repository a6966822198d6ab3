// SPDX-License-Identifier: Apache-2.0
#include "estimator/degeneracy.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace lxd {
namespace {

constexpr double kHeldRatio = 2;          // information over noise: the noise is known by its order only
constexpr double kRoundingNoise = 1e-12;  // rad^2: what float normals and sums give where there is none

// Information over noise of the pose alone, along the generalised eigenvectors of both.
Vector6d pose_sensitivity(const LidarMatrix& information, const LidarMatrix& noise) {
  const Eigen::LLT<Matrix6d> root(noise.topLeftCorner<6, 6>());
  if (root.info() != Eigen::Success) return Vector6d::Zero();
  const Matrix6d half = root.matrixL().solve(information.topLeftCorner<6, 6>());
  const Matrix6d ratio = root.matrixL().solve(half.transpose());
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(0.5 * (ratio + ratio.transpose()), Eigen::EigenvaluesOnly)
      .eigenvalues();
}

}  // namespace

Degeneracy find_degeneracy(const NormalEquations& sums, const LidarMatrix& prior_root, double normal_variance) {
  Degeneracy out;
  out.directions = 6;
  if (!(sums.weight > 0)) return out;
  const LidarMatrix noise = std::max(normal_variance, kRoundingNoise) * sums.motion;
  out.sensitivity = pose_sensitivity(sums.information, noise);
  out.directions = static_cast<std::uint8_t>((out.sensitivity.array() < kHeldRatio).count());
  const LidarMatrix whitened = prior_root.transpose() * sums.information * prior_root;
  const Eigen::SelfAdjointEigenSolver<LidarMatrix> solver(0.5 * (whitened + whitened.transpose()));
  out.axes = prior_root * solver.eigenvectors();
  out.duals = prior_root.transpose().triangularView<Eigen::Upper>().solve(solver.eigenvectors());
  out.information = solver.eigenvalues().cwiseMax(0.0);
  const LidarVector by_noise = (out.axes.transpose() * noise * out.axes).diagonal();
  out.trust = (1.0 - kHeldRatio * by_noise.array() / out.information.array().max(1e-300)).max(0.0).matrix();
  return out;
}

void discount(const Degeneracy& degeneracy, NormalEquations& sums) {
  const LidarVector kept = degeneracy.trust.cwiseProduct(degeneracy.information);
  const LidarVector along = degeneracy.axes.transpose() * sums.gradient;
  sums.information = degeneracy.duals * kept.asDiagonal() * degeneracy.duals.transpose();
  sums.gradient = degeneracy.duals * degeneracy.trust.cwiseProduct(along);
}

}  // namespace lxd
