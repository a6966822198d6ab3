// SPDX-License-Identifier: Apache-2.0
// The real-time path of the odometry allocates nothing: from the first sweep on, through tracking, rejected sweeps and
// sweeps that see nothing.
#include <vector>

#include <gtest/gtest.h>

#include "rt/allocation_guard.hpp"
#include "tests/support/room_sweeps.hpp"

namespace lxd {
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

}  // namespace
}  // namespace lxd
