// SPDX-License-Identifier: Apache-2.0
// Does what an IMU reads look like what the rig file says of it? Wrong units, signs and clocks give paths that bend or
// an IMU that is never used; here they get a sentence for the user. Never the real-time path's business.
#pragma once

#include <string>
#include <vector>

#include "board/delay_hint.hpp"
#include "board/found_mount.hpp"
#include "estimator/odometry.hpp"
#include "rt/imu_sample.hpp"

namespace lxd {

class ImuHints {
 public:
  // Every sample that was handed to the filter, at its rig time.
  void note(RigTime t, const ImuSample& sample);
  // Every sweep, taken or rejected, and the filter after it.
  void note(RigTime begin, RigTime end, const Odometry& odometry, const Star& star);

  // What the user should look at; none: nothing is amiss.
  [[nodiscard]] std::vector<std::string> sentences() const;

 private:
  [[nodiscard]] std::string of_time() const;
  [[nodiscard]] std::string of_force() const;
  [[nodiscard]] std::string of_rate() const;
  [[nodiscard]] std::string of_up() const;

  std::uint64_t samples_ = 0, quick_ = 0;
  double force_sum_mps2_ = 0;
  RigTime first_ = kNever, last_ = kNever;
  RigTime first_sweep_ = kNever, last_sweep_ = kNever;
  std::uint64_t propagated_ = 0;  // sweeps
  DelayHint delay_;
  MountHint mount_{"imu",
                   "it turns otherwise than the LiDAR does (is imu.T_reference_sensor or lidar0.T_reference_sensor the "
                   "inverse of what is meant, or are its axes other than those of the datasheet?)"};
  double up_z_ = 1;  // of gravity's upward direction in the reference's axes, when last propagated
};

}  // namespace lxd
