// SPDX-License-Identifier: Apache-2.0
// An odometry that watches a carrier on its steady way through a room, and what it makes of it.
#pragma once

#include <vector>

#include "tests/support/room_sweeps.hpp"

namespace lxd::test {

// A carrier that goes on steadily through a room, and an odometry that watches. Truth is relative to the end of the
// first sweep, which is the odometry's world.
class Journey {
 public:
  explicit Journey(const State& start, const Room& room = {}, const OdometrySetup& setup = small_setup())
      : sweeps(room), truth(start), odometry(setup), origin_(propagate(start, kSweepSpan.seconds()).pose()) {}

  const SweepOutcome& sweep() {
    const SweepOutcome& outcome = odometry->step(sweeps.next(truth, begin_ns));
    pass(kSweepSpan.ns());
    return outcome;
  }
  const SweepOutcome& sweep_of(std::vector<LidarPoint> points) {
    const SweepOutcome& outcome = odometry->step(sweeps.with_points(std::move(points), begin_ns));
    pass(kSweepSpan.ns());
    return outcome;
  }
  void pass(std::int64_t ns) {
    truth = propagate(truth, static_cast<double>(ns) * 1e-9);
    begin_ns += ns;
  }
  // Of a pose at the end of the last sweep.
  [[nodiscard]] double shift_error_m(const Pose& pose) const {
    return (pose.p - (origin_.inverse() * truth.pose()).p).norm();
  }
  [[nodiscard]] double turn_error_rad(const Pose& pose) const {
    return Log(pose.R.transpose() * (origin_.inverse() * truth.pose()).R).norm();
  }

  RoomSweeps sweeps;
  State truth;
  std::int64_t begin_ns = 1'000'000'000;
  OwnedOdometry odometry;

 private:
  Pose origin_;
};

inline State moving(const Eigen::Vector3d& v_mps, const Eigen::Vector3d& rate_radps = Eigen::Vector3d::Zero()) {
  State x;
  x.v = v_mps;
  x.b_g = -rate_radps;
  return x;
}

}  // namespace lxd::test
