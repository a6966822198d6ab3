// SPDX-License-Identifier: Apache-2.0
// Overload is shed by points and iterations, and taken back when there is room.
#include <gtest/gtest.h>

#include "estimator/work_budget.hpp"
#include "tests/support/room_journey.hpp"

namespace lxd::estimator_work_budget_test {
namespace {

constexpr Duration kBudget = Duration::from_ns(10'000'000);

Duration share(double of_budget) { return Duration::from_seconds(of_budget * kBudget.seconds()); }

TEST(WorkBudget, WithoutOneNothingIsShed) {
  WorkBudget none{Duration()};
  none.begin();
  EXPECT_TRUE(none.allows_iteration());
  EXPECT_FALSE(none.end());
  EXPECT_EQ(none.points_share(), 1);
}

// Given sweeps that take too long; then each wants fewer points than the last, down to a quarter; when they are quick
// again, all points come back; in between nothing changes.
TEST(WorkBudget, PointsAreShedAndComeBack) {
  WorkBudget budget(kBudget);
  EXPECT_FALSE(budget.took(share(1.0)));
  EXPECT_EQ(budget.points_share(), 1);
  double before = 1;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(budget.took(share(1.01)));
    EXPECT_LT(budget.points_share(), before);
    before = budget.points_share();
  }
  EXPECT_FALSE(budget.took(share(0.8)));
  EXPECT_EQ(budget.points_share(), before);
  for (int i = 0; i < 20; ++i) budget.took(share(5));
  EXPECT_EQ(budget.points_share(), WorkBudget::kPointsMin);
  for (int i = 0; i < 20; ++i) budget.took(share(0.5));
  EXPECT_EQ(budget.points_share(), 1);
}

TEST(WorkBudget, IterationsEndWithTheTime) {
  WorkBudget spent(Duration::from_ns(1));
  spent.begin();
  EXPECT_FALSE(spent.allows_iteration());
  WorkBudget ample(Duration::from_seconds(3600));
  ample.begin();
  EXPECT_TRUE(ample.allows_iteration());
}

// Given a budget that no sweep can keep; then every sweep is one iteration of ever fewer points, none is skipped, and
// the pose holds.
TEST(WorkBudget, AnOverloadedOdometrySkipsNothingAndHolds) {
  OdometrySetup setup = test::small_setup();
  setup.estimator.budget_ms = 1e-3;
  test::Journey journey(test::moving({0.5, 0, 0}), {}, setup), free_one(test::moving({0.5, 0, 0}));
  for (int i = 0; i < 15; ++i) {
    const SweepOutcome& outcome = journey.sweep();
    free_one.sweep();
    ASSERT_EQ(outcome.rejection, SweepRejection::none) << i;
    if (i < 2) continue;
    EXPECT_TRUE(outcome.over_budget) << i;
    EXPECT_TRUE(outcome.tracked) << i;
    EXPECT_EQ(outcome.iterations, 1U) << i;
  }
  EXPECT_LT(journey.odometry->outcome().points_used, free_one.odometry->outcome().points_used);
  EXPECT_FALSE(free_one.odometry->outcome().over_budget);
  EXPECT_LT(journey.shift_error_m(journey.odometry->outcome().T_world_body), 0.03);
}

}  // namespace
}  // namespace lxd::estimator_work_budget_test
