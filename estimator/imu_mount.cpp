// SPDX-License-Identifier: Apache-2.0
#include "estimator/imu_mount.hpp"

#include <optional>

namespace lxd {
namespace {

MountedCamera mounted_imu(double rotation_sigma_rad) {
  MountedCamera imu{};
  imu.rotation_sigma_rad = rotation_sigma_rad;
  return imu;
}

}  // namespace

ImuMount::ImuMount(double rotation_sigma_rad) : alignment_(mounted_imu(rotation_sigma_rad)) {}

void ImuMount::compare(RigTime then, RigTime now, const Eigen::Matrix3d& by_lidar, const Eigen::Matrix3d& by_imu,
                       const Eigen::Matrix3d& covariance_rad2) noexcept {
  if (known()) return;
  const Eigen::Matrix3d& R = R_body_imu();
  alignment_.pass(now - then);
  alignment_.compare({then, now, R.transpose() * by_imu * R, R.transpose() * covariance_rad2 * R},
                     [&](RigTime, RigTime) { return std::optional<Eigen::Matrix3d>(by_lidar); });
}

}  // namespace lxd
