// SPDX-License-Identifier: Apache-2.0
// Alignment of paths.
#include "tools/evaluate/align.hpp"

#include <Eigen/SVD>

namespace lxd {
namespace {

struct Centroids {
  Eigen::Vector3d estimate = Eigen::Vector3d::Zero();
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
};

Centroids centroids_of(std::span<const PosePair> pairs) {
  Centroids sum;
  for (const PosePair& pair : pairs) {
    sum.estimate += pair.estimate.p;
    sum.truth += pair.truth.p;
  }
  const auto count = static_cast<double>(pairs.size());
  return {sum.estimate / count, sum.truth / count};
}

// The rotation nearest to a correlation matrix (Umeyama, equation 43: the sign keeps it a rotation).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& correlation) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

Pose align_path(std::span<const PosePair> pairs, double lever_m) {
  if (pairs.empty()) return {};
  const Centroids centre = centroids_of(pairs);
  const double lever_weight = lever_m * lever_m;
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) {
    correlation += (pair.truth.p - centre.truth) * (pair.estimate.p - centre.estimate).transpose();
    correlation += lever_weight * pair.truth.R * pair.estimate.R.transpose();
  }
  Pose T;
  T.R = nearest_rotation(correlation);
  T.p = centre.truth - T.R * centre.estimate;
  return T;
}

Pose align_first(std::span<const PosePair> pairs) { return pairs.front().truth * pairs.front().estimate.inverse(); }

}  // namespace lxd
