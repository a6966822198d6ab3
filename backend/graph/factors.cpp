// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/factors.hpp"

#include "rt/so3.hpp"

namespace lxd {
namespace {

Eigen::Matrix3d about_up(double yaw_rad) { return Exp(Eigen::Vector3d(0, 0, yaw_rad)); }

}  // namespace

// With R = R_a^T R_b and e = Log(R_measured^T R): R_a Exp(d) makes it Log(R_measured^T R Exp(-R^T d)).
Vector6d RelativeFactor::evaluate(const Pose& T_map_a, const Pose& T_map_b, Matrix6d* by_a, Matrix6d* by_b) const {
  const Pose T = T_map_a.inverse() * T_map_b;
  const Vector6d e = box_minus(T, T_a_b);
  const Eigen::Matrix3d J = Jr_inverse(e.head<3>());
  if (by_a != nullptr) {
    by_a->setZero();
    by_a->topLeftCorner<3, 3>() = -J * T.R.transpose();
    by_a->bottomLeftCorner<3, 3>() = hat(T.p);
    by_a->bottomRightCorner<3, 3>() = -T_map_a.R.transpose();
    *by_a = sqrt_information * *by_a;
  }
  if (by_b != nullptr) {
    by_b->setZero();
    by_b->topLeftCorner<3, 3>() = J;
    by_b->bottomRightCorner<3, 3>() = T_map_a.R.transpose();
    *by_b = sqrt_information * *by_b;
  }
  return sqrt_information * e;
}

Eigen::Vector3d EarthAlignment::to_enu(const Eigen::Vector3d& p_map_m) const {
  return about_up(yaw_rad) * p_map_m + offset_m;
}

Eigen::Vector3d EarthAlignment::antenna_enu_m(const Pose& T_map_body, const Eigen::Vector3d& antenna_m,
                                              const Eigen::Vector3d& velocity_mps) const {
  return to_enu(T_map_body * (antenna_m - delay_s * velocity_mps));
}

Eigen::Vector3d GnssFactor::evaluate(const Pose& T_map_body, const EarthAlignment& alignment, const Eigen::Vector3d& b,
                                     Eigen::Matrix<double, 3, 6>* by_pose,
                                     Eigen::Matrix<double, 3, kAlignmentSize>* by_alignment) const {
  const Eigen::Vector3d antenna = antenna_body_m - alignment.delay_s * antenna_velocity_mps;
  const Eigen::Matrix3d R_enu_map = about_up(alignment.yaw_rad), R_enu_body = R_enu_map * T_map_body.R;
  if (by_pose != nullptr) *by_pose << -sqrt_information * R_enu_body * hat(antenna), sqrt_information * R_enu_map;
  if (by_alignment != nullptr) {
    const Eigen::Vector3d turned = Eigen::Vector3d::UnitZ().cross(R_enu_map * (T_map_body * antenna));
    *by_alignment << sqrt_information * turned, sqrt_information, -sqrt_information * R_enu_body * antenna_velocity_mps;
  }
  const Eigen::Vector3d error_m = alignment.antenna_enu_m(T_map_body, antenna_body_m, antenna_velocity_mps) - enu_m;
  return sqrt_information * (error_m + lasting_root * b);
}

// (R Exp(d))^T z = R^T z + [R^T z]x d.
Eigen::Vector3d TiltFactor::evaluate(const Pose& T_map_body, Eigen::Matrix<double, 3, 6>* by_pose) const {
  const Eigen::Vector3d up = T_map_body.R.transpose() * Eigen::Vector3d::UnitZ();
  if (by_pose != nullptr) *by_pose << hat(up) / sigma_rad, Eigen::Matrix3d::Zero();
  return (up - up_body) / sigma_rad;
}

// The rotation's error in the map's axes: Log(R R_0^T) = R_0 Log(R_0^T R).
Vector6d AnchorFactor::evaluate(const Pose& T, Matrix6d* by_pose) const {
  Vector6d e = box_minus(T, T_map_body);
  if (by_pose != nullptr) {
    by_pose->setIdentity();
    by_pose->topLeftCorner<3, 3>() = T_map_body.R * Jr_inverse(e.head<3>());
    *by_pose = sigmas.cwiseInverse().asDiagonal() * *by_pose;
  }
  e.head<3>() = T_map_body.R * e.head<3>();
  return e.cwiseQuotient(sigmas);
}

}  // namespace lxd
