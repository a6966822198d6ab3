// SPDX-License-Identifier: Apache-2.0
// Precision and recall, by hand.
#include <gtest/gtest.h>

#include "tools/loops/curve.hpp"

namespace lxd::tools_loop_curve_test {
namespace {

TEST(LoopCurve, CountsAsByHand) {
  const Curve curve = precision_recall({{0.1, true}, {0.4, true}, {0.2, true}, {0.3, false}, {0.5, false}});
  EXPECT_DOUBLE_EQ(curve.recall_at_full_precision, 2.0 / 3);
  EXPECT_DOUBLE_EQ(curve.threshold_at_full_precision, 0.2);
  EXPECT_DOUBLE_EQ(curve.average_precision, (1.0 + 1.0 + 0.75) / 3);
  ASSERT_EQ(curve.points.size(), 5U);
  EXPECT_DOUBLE_EQ(curve.points[4].precision, 0.6);
}

TEST(LoopCurve, EqualDistancesStandOrFallTogether) {
  const Curve curve = precision_recall({{0.1, true}, {0.1, false}, {0.2, true}});
  EXPECT_EQ(curve.recall_at_full_precision, 0);
  EXPECT_EQ(curve.points.size(), 2U);
}

TEST(LoopCurve, WithoutTruePairsThereIsNoRecall) {
  EXPECT_EQ(precision_recall({{0.1, false}}).recall_at_full_precision, 0);
  EXPECT_TRUE(precision_recall({}).points.empty());
}

}  // namespace
}  // namespace lxd::tools_loop_curve_test
