// SPDX-License-Identifier: Apache-2.0
#include "board/pose_port.hpp"

namespace lxd {

MotionAnchor anchor_of(const Odometry& odometry) noexcept {
  MotionAnchor anchor = MotionAnchor::of(odometry.state_time(), odometry.state(), odometry.motion().inertial(),
                                         odometry.outcome().tracked);
  anchor.imu_delay = odometry.motion().imu_delay();
  return anchor;
}

Result<std::unique_ptr<PosePort>> PosePort::open(const UdpEndpoint& to, const Star& star) {
  auto outlet = UdpOutlet::open(to);
  if (!outlet) return outlet.error();
  return std::unique_ptr<PosePort>(new PosePort(std::move(*outlet), star));
}

PosePort::PosePort(UdpOutlet outlet, const Star& star)
    : outlet_(std::move(outlet)),
      T_body_reference_(star.T_body_reference),
      history_block_(kHistoryBytes),
      history_arena_(history_block_),
      predictor_(history_arena_),
      left_slots_(kLeft),
      left_(left_slots_) {}

void PosePort::leave(const MotionAnchor& anchor, const Eigen::Matrix<double, 6, 6>& covariance) noexcept {
  const auto variances = covariance.diagonal();
  left_.push({anchor, std::sqrt(variances.tail<3>().maxCoeff()), std::sqrt(variances.head<3>().maxCoeff())});
}

void PosePort::add(const ImuSample& sample) noexcept {
  while (const auto left = left_.pop()) {
    predictor_.take(left->anchor);
    sigma_m_ = left->sigma_m;
    sigma_rad_ = left->sigma_rad;
  }
  const auto now = predictor_.add({sample.t, sample.gyro_radps, sample.accel_mps2});
  if (now) outlet_.send(encode(message_of(*now)));
}

// The reference rides on the body: R_world_body w x l is what its lever arm adds to the velocity.
PoseMessage PosePort::message_of(const PredictedState& now) noexcept {
  PoseMessage message;
  message.tracked = now.tracked;
  message.count = count_++;
  message.t = now.t;
  message.reach = now.reach;
  message.T_world_reference = now.x.pose() * T_body_reference_;
  message.v_world_mps = now.x.v + now.x.R * now.rate_radps.cross(T_body_reference_.p);
  message.rate_radps = T_body_reference_.R.transpose() * now.rate_radps;
  message.sigma_m = sigma_m_;
  message.sigma_rad = sigma_rad_;
  return message;
}

}  // namespace lxd
