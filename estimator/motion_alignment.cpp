// SPDX-License-Identifier: Apache-2.0
// What the poses that the LiDAR holds tell of the wheels' clock and of the IMU's axes.
#include "estimator/motion.hpp"

namespace lxd {
namespace {

constexpr Duration kWheelWay = Duration::from_ns(500'000'000);  // at least, between poses that tell the wheels' clock
constexpr Duration kTurnSpan = Duration::from_ns(500'000'000);  // likewise, the IMU's axes
constexpr Duration kTurnSpanMax = Duration::from_ns(800'000'000);  // more is not kept of its readings
constexpr double kTurnSeen_rad = 0.05;                             // less is the gyroscope's bias
constexpr double kTurnedEnough_rad2 = 0.2;                         // sum of squares

}  // namespace

void Motion::align_sensors(const State& x, RigTime at, const Pose& T_world_body) noexcept {
  if (setup_.wheel && !wheel_alignment_.known()) align_wheels(at, T_world_body);
  if (setup_.imu) compare_turns(x, at, T_world_body.R);
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

void Motion::compare_turns(const State& x, RigTime at, const Eigen::Matrix3d& R_world_body) noexcept {
  if (!inertial_) return turned_from_.reset();
  if (turned_from_ && at - turned_from_->t < kTurnSpan) return;
  const auto by_imu = turned_from_ && at - turned_from_->t < kTurnSpanMax ? turn(x, turned_from_->t, at) : std::nullopt;
  if (by_imu) {
    const Eigen::Matrix3d by_lidar = turned_from_->T_world_body.R.transpose() * R_world_body;
    const double turned_rad2 = Log(by_lidar).squaredNorm();
    if (turned_rad2 > kTurnSeen_rad * kTurnSeen_rad) {
      lacking_rad2_ += Log(by_lidar.transpose() * *by_imu).squaredNorm();
      turned_rad2_ += turned_rad2;
    }
  }
  turned_from_ = {at, {R_world_body, Eigen::Vector3d::Zero()}};
}

double Motion::imu_unlike() const { return turned_rad2_ > kTurnedEnough_rad2 ? lacking_rad2_ / turned_rad2_ : 0; }

}  // namespace lxd
