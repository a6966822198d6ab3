// SPDX-License-Identifier: Apache-2.0
// What the poses that the LiDAR holds tell of the wheels' clock and of the IMU's mount.
#include "estimator/motion.hpp"

namespace lxd {
namespace {

constexpr Duration kWheelWay = Duration::from_ns(500'000'000);    // at least, between poses that tell the wheels' clock
constexpr Duration kImuTurn = Duration::from_ns(500'000'000);     // likewise, the IMU's mount
constexpr Duration kImuTurnMax = Duration::from_ns(800'000'000);  // more is not kept of its readings
constexpr double kLidarTurnSigma_rad = 5e-4;                      // of the turn between them, an axis

}  // namespace

void Motion::align_sensors(Ieskf& filter, RigTime at, const Pose& T_world_body) noexcept {
  if (setup_.wheel && !wheel_alignment_.known()) align_wheels(at, T_world_body);
  if (setup_.imu && !imu_mount_.known()) align_imu(filter, at, T_world_body.R);
}

// The new delay holds from the next prediction on.
void Motion::align_wheels(RigTime at, const Pose& T_world_body) noexcept {
  if (rolled_from_ && at - rolled_from_->t < kWheelWay) return;
  const Pose& T = setup_.wheel->T_body_wheel;
  if (rolled_from_) {
    const auto rolled = wheel_.way(rolled_from_->t, at);
    if (rolled)
      wheel_alignment_.compare(driven_arc(rolled_from_->T_world_body * T, T_world_body * T), *rolled, rolled->span_s);
  }
  rolled_from_ = {at, T_world_body};
}

// What is read from now on is turned as it is known now. Gravity was told from readings turned otherwise: in the body's
// axes it turns with them.
void Motion::align_imu(Ieskf& filter, RigTime at, const Eigen::Matrix3d& R_world_body) noexcept {
  if (!inertial_) return turned_from_.reset();
  if (turned_from_ && at - turned_from_->t < kImuTurn) return;
  if (turned_from_ && at - turned_from_->t < kImuTurnMax) {
    const auto by_imu = turn(filter.state(), turned_from_->t, at);
    const double span_s = (at - turned_from_->t).seconds(), density = setup_.imu->gyro_density;
    const Eigen::Matrix3d doubt =
        (density * density * span_s + kLidarTurnSigma_rad * kLidarTurnSigma_rad) * Eigen::Matrix3d::Identity() +
        span_s * span_s * filter.covariance().block<3, 3>(kGyroBias, kGyroBias);
    const Eigen::Matrix3d before = imu_mount_.R_body_imu();
    if (by_imu)
      imu_mount_.compare(turned_from_->t, at, turned_from_->T_world_body.R.transpose() * R_world_body, *by_imu, doubt);
    const Eigen::Matrix3d& R = filter.state().R;
    filter.turn_gravity(R * imu_mount_.R_body_imu() * before.transpose() * R.transpose());
  }
  turned_from_ = {at, {R_world_body, Eigen::Vector3d::Zero()}};
}

}  // namespace lxd
