// SPDX-License-Identifier: Apache-2.0
// The real-time path of the odometry allocates nothing: from the first sweep on, through tracking, rejected sweeps and
// sweeps that see nothing.
#include <vector>

#include <gtest/gtest.h>

#include "rt/allocation_guard.hpp"
#include "tests/support/carried_body.hpp"
#include "tests/support/room_sweeps.hpp"

namespace lxd::estimator_real_time_test {
namespace {

// Sweeps made beforehand: casting rays allocates.
struct MadeSweep {
  Sweep sweep;
  std::vector<LidarPoint> points;
};

std::vector<MadeSweep> made_sweeps(int count) {
  test::RoomSweeps sweeps;
  State x;
  x.v = {0.5, 0.2, 0.0};
  x.b_g = {0, 0, -0.3};
  std::vector<MadeSweep> out(count);
  for (int i = 0; i < count; ++i) {
    out[i].sweep = sweeps.next(x, i * test::kSweepSpan.ns());
    out[i].points = sweeps.points();
    if (i % 10 == 7) out[i].points.resize(5);  // too few
    if (i % 10 == 9)
      for (LidarPoint& p : out[i].points) p.x_m += 80.0F;  // nothing known
    out[i].sweep.storage = out[i].points;
    out[i].sweep.count = static_cast<std::uint32_t>(out[i].points.size());
    x = propagate(x, test::kSweepSpan.seconds());
  }
  return out;
}

TEST(EstimatorRealTime, OdometryAllocatesNothingOverManySweeps) {
  const auto sweeps = made_sweeps(60);
  test::OwnedOdometry odometry;
#ifndef LXD_SANITIZED
  ASSERT_TRUE(AllocationGuard::active()) << "this executable does not link lxd_alloc_hook";
#endif
  int tracked = 0, rejected = 0;
  const AllocationGuard guard;
  for (const MadeSweep& made : sweeps) {
    const SweepOutcome& outcome = odometry->step(made.sweep);
    tracked += outcome.tracked;
    rejected += outcome.rejection != SweepRejection::none;
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
  EXPECT_GE(tracked, 40);
  EXPECT_EQ(rejected, 6);
}

// With an IMU that falls silent and returns, wheels, rest and motion.
TEST(EstimatorRealTime, MotionAllocatesNothingWhateverCarriesIt) {
  test::Carried body = test::aligned(test::driving_about(), 2.0, test::with_both());
  std::vector<InertialReading> readings;
  std::vector<WheelReading> wheels;
  for (double t = 2.6; t < 4.0; t += 0.005) readings.push_back(body.way.reading(t));
  for (double t = 1.0; t < 4.0; t += 0.02) wheels.push_back(body.way.wheel(t));
  SweepPath path;
  int inertial = 0, other = 0;
  const AllocationGuard guard;
  for (const InertialReading& reading : readings) body.motion.add(reading);
  for (const WheelReading& reading : wheels) body.motion.add(reading);
  for (int i = 0; i < 28; ++i) {
    (body.sweep() == MotionSource::imu ? inertial : other) += 1;
    body.motion.path(body.filter.state(), test::at(body.now_s - test::kSweep_s), test::at(body.now_s), path);
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
  EXPECT_GE(inertial, 20);
  EXPECT_GE(other, 6);
}

}  // namespace
}  // namespace lxd::estimator_real_time_test
