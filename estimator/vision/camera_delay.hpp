// SPDX-License-Identifier: Apache-2.0
// By how much a camera's images are stamped later than the LiDAR's returns of the same instant. The turn between two
// images, which their features tell, is held against that of the path between their instants: when the images are late
// by d it is the turn of a little earlier, and differs by how much faster the body turns by now. A body that turns
// steadily, or rests, tells nothing. README.md, "The camera's delay". Real-time thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "estimator/vision/attitude_track.hpp"
#include "estimator/vision/turn_meter.hpp"

namespace lxd {

class CameraDelay {
 public:
  CameraDelay() = default;  // known exactly: none
  // At first: s, and how sure that is; 0: exactly.
  CameraDelay(double delay_s, double sigma_s) : delay_s_(delay_s), variance_s2_(sigma_s * sigma_s) {}

  [[nodiscard]] double delay_s() const { return delay_s_; }  // an instant's image is stamped so much later
  [[nodiscard]] double sigma_s() const { return std::sqrt(variance_s2_); }
  [[nodiscard]] Duration delay() const { return Duration::from_seconds(delay_s_); }
  [[nodiscard]] bool known() const { return !(variance_s2_ > 0); }

  // Time has passed: clocks drift apart.
  void pass(Duration span) noexcept;

  // path_turn(then, now) -> std::optional<Eigen::Matrix3d>: R_then_now of the body, between two instants.
  template <typename PathTurn>
  void compare(const ImageTurn& seen, PathTurn&& path_turn) noexcept {
    const RigTime then = seen.then - delay(), now = seen.now - delay();
    const auto turn = path_turn(then, now), earlier = path_turn(then - kEarlier, now - kEarlier);
    if (turn && earlier)
      learn(Log(turn->transpose() * seen.R_then_now), Log(turn->transpose() * *earlier) / kEarlier.seconds(),
            seen.covariance_rad2);
  }

  // Where the LiDAR alone knows the path: the attitude at a sweep's end. The turn waits until the sweeps after it are
  // known.
  void follow(RigTime end, const Eigen::Matrix3d& R_world_body, const ImageTurn* seen) noexcept;
  void forget_path() {
    attitudes_.clear();
    waiting_count_ = 0;
  }

 private:
  static constexpr Duration kEarlier = Duration::from_ns(10'000'000);
  static constexpr std::size_t kWaiting = 6;

  // What the path's turn lacks to the images' (rad), and how much of that a second of delay makes.
  void learn(const Eigen::Vector3d& lacking, const Eigen::Vector3d& by_delay,
             const Eigen::Matrix3d& covariance) noexcept;

  double delay_s_ = 0, variance_s2_ = 0;
  double misfit_ = 1;  // running mean of squared ratios of what no delay explains; 1: as large as it should be
  AttitudeTrack attitudes_;
  std::array<ImageTurn, kWaiting> waiting_;
  std::size_t waiting_count_ = 0;
};

}  // namespace lxd
