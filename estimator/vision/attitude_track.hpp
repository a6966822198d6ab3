// SPDX-License-Identifier: Apache-2.0
// The body's attitude between the ends of sweeps, as the LiDAR has found it there: without an IMU the best that is
// known of how the body turned in between, once the sweep after has been seen. Real-time thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "rt/so3.hpp"
#include "rt/time.hpp"

namespace lxd {

class AttitudeTrack {
 public:
  static constexpr std::uint32_t kEnds = 8;

  void clear() { count_ = 0; }
  // In the order of time. One that is too far from the last begins anew.
  void add(RigTime t, const Eigen::Matrix3d& R_world_body) noexcept;

  // Is `t` before the end before the last, so that more is not going to be known?
  [[nodiscard]] bool knows(RigTime t) const { return count_ >= 2 && t <= at(count_ - 2).t; }
  // R_then_now; nothing where one of the two has not two ends on each side.
  [[nodiscard]] std::optional<Eigen::Matrix3d> turn(RigTime then, RigTime now) const noexcept;

 private:
  struct End {
    RigTime t;
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  };
  [[nodiscard]] const End& at(std::uint32_t i) const { return ends_[(first_ + i) % kEnds]; }
  [[nodiscard]] std::optional<Eigen::Matrix3d> attitude(RigTime t) const noexcept;

  std::array<End, kEnds> ends_;
  std::uint32_t first_ = 0, count_ = 0;
};

}  // namespace lxd
