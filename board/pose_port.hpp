// SPDX-License-Identifier: Apache-2.0
// Where the rig is, for whoever steers it: a datagram for every reading of the IMU, from the thread that reads the IMU.
// The real-time thread only leaves its state behind after each sweep.
#pragma once

#include <memory>
#include <vector>

#include "board/pose_message.hpp"
#include "board/star.hpp"
#include "drivers/device/udp_outlet.hpp"
#include "estimator/odometry.hpp"
#include "estimator/pose_predictor.hpp"
#include "rt/imu_sample.hpp"
#include "rt/spsc_drop_oldest_ring.hpp"

namespace lxd {

// What the last sweep left.
MotionAnchor anchor_of(const Odometry& odometry) noexcept;

class PosePort {
 public:
  // Error: no way to the receiver.
  static Result<std::unique_ptr<PosePort>> open(const UdpEndpoint& to, const Star& star);

  // Real-time thread, after a sweep: the filter's state, and the covariance of its pose.
  void leave(const MotionAnchor& anchor, const Eigen::Matrix<double, 6, 6>& covariance) noexcept;
  // Reading thread.
  void add(const ImuSample& sample) noexcept;

  // Reading thread, or after it.
  [[nodiscard]] const UdpOutlet& outlet() const { return outlet_; }

 private:
  struct Left {
    MotionAnchor anchor;
    double sigma_m = 0, sigma_rad = 0;
  };
  static constexpr std::size_t kLeft = 4;  // only the newest is wanted
  static constexpr std::size_t kHistoryBytes = 1U << 20U;

  PosePort(UdpOutlet outlet, const Star& star);
  [[nodiscard]] PoseMessage message_of(const PredictedState& now) noexcept;

  UdpOutlet outlet_;
  Pose T_body_reference_;
  std::vector<std::byte> history_block_;
  Arena history_arena_;
  PosePredictor predictor_;
  std::vector<SpscDropOldestRing<Left>::Slot> left_slots_;
  SpscDropOldestRing<Left> left_;
  double sigma_m_ = 0, sigma_rad_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace lxd
