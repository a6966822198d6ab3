// SPDX-License-Identifier: Apache-2.0
// A rigid transform T_to_from: p_to = R * p_from + p. double; the estimator's manifold lives in rt/so3.hpp.
#pragma once

#include <Eigen/Geometry>

namespace lxd {

struct Pose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  // m

  [[nodiscard]] Pose inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
  [[nodiscard]] Eigen::Quaterniond quaternion() const { return Eigen::Quaterniond(R).normalized(); }
};

inline Pose operator*(const Pose& a, const Pose& b) { return {a.R * b.R, a.R * b.p + a.p}; }
inline Eigen::Vector3d operator*(const Pose& T, const Eigen::Vector3d& p) { return T.R * p + T.p; }

}  // namespace lxd
