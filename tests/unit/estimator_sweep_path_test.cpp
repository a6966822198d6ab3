// SPDX-License-Identifier: Apache-2.0
// The body's path during a sweep: where it ends, how it hangs on the end state, and that deskewing with it undoes what
// a steadily moving carrier's sweep suffered.
#include <gtest/gtest.h>

#include "estimator/propagation.hpp"
#include "estimator/sweep_path.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_sweep_path_test {
namespace {

using Eigen::Vector3d;
using test::check_property;
using test::StateChance;

constexpr Duration kSpan = Duration::from_ns(100'000'000);
constexpr auto kSpan_ns = static_cast<std::uint32_t>(kSpan.ns());
constexpr double kFullTurnPoint_m = 30;

StateChance any_chance() { return StateChance(*rc::gen::arbitrary<unsigned>()); }

SweepPath path_of(const State& end, Duration span = kSpan) {
  SweepPath path;
  path.set(end, span);
  return path;
}

TEST(EstimatorSweepPath, ThePathEndsInTheEndState) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const State end = chance.state();
        const SweepPath path = path_of(end);
        RC_ASSERT(SweepPath::knot(end, 0).R == end.R);
        RC_ASSERT(SweepPath::knot(end, 0).p == end.p);
        // A thousandth of an interval before the end is where the interpolation stops.
        const Vector3d q = chance.vector(10);
        const double stop_m =
            1e-3 * kSpan.seconds() / SweepPath::kIntervals * (end.v.norm() + end.b_g.norm() * q.norm());
        RC_ASSERT((path.to_world(q, kSpan_ns) - end.pose() * q).norm() <= 1.01 * stop_m + 1e-12);
      },
      200);
}

TEST(EstimatorSweepPath, ThePathIsThePropagationBackwards) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const State begin = chance.state();
        const double tau = chance.uniform(0, 0.1);
        const PathKnot knot = SweepPath::knot(propagate(begin, tau), tau);
        RC_ASSERT((knot.R - begin.R).norm() < 1e-12);
        RC_ASSERT((knot.p - begin.p).norm() < 1e-12);
      },
      200);
}

TEST(EstimatorSweepPath, BetweenKnotsPointsAreWhereTheExactPathHasThem) {
  // Given the fastest rotation that the header's bound speaks of, 5 rad/s ...
  StateChance chance(11);
  State end = chance.state();
  end.b_g = 5.0 * chance.direction();
  const SweepPath path = path_of(end);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d q = kFullTurnPoint_m * chance.direction();
    const auto offset_ns = static_cast<std::uint32_t>(chance.uniform(0, 0.999) * kSpan_ns);
    const PathKnot then = SweepPath::knot(end, (kSpan - Duration::from_ns(offset_ns)).seconds());
    const Vector3d exact = then.R * q + then.p;
    // ... then the error is at most 8e-6 of the point's distance, and what float adds to times (1e-7 of the span).
    const double time_m = 1e-7 * kSpan.seconds() * (5 * kFullTurnPoint_m + end.v.norm());
    ASSERT_LT((path.to_world(q, offset_ns) - exact).norm(), 8e-6 * kFullTurnPoint_m + time_m);
  }
}

TEST(EstimatorSweepPath, TheFloatPathAgreesWithTheDoubleOneRelativeToItsOrigin) {
  StateChance chance(12);
  const SweepPath path = path_of(chance.state());
  for (int i = 0; i < 1000; ++i) {
    const Vector3d q = kFullTurnPoint_m * chance.direction();
    const auto offset_ns = static_cast<std::uint32_t>(chance.uniform(0, 1) * kSpan_ns);
    const Vector3d local = path.to_local(q.cast<float>(), offset_ns).cast<double>();
    ASSERT_LT((path.origin() + local - path.to_world(q, offset_ns)).norm(), 2e-5);
  }
}

TEST(EstimatorSweepPath, HowAPointMovesWithTheEndStateAgreesWithNumericDifferentiation) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const State end = chance.state();
        const double tau = chance.uniform(0, 0.2);
        const Vector3d q = chance.vector(10), n = chance.direction();
        const auto numeric = test::numeric_jacobian<3>(end, [&](const State& x) -> Vector3d {
          const PathKnot k = SweepPath::knot(x, tau);
          return k.R * q + k.p;
        });
        const PathKnot knot = SweepPath::knot(end, tau);
        const Eigen::Matrix<double, 3, kLidarDim> J = numeric.leftCols<kLidarDim>();
        RC_ASSERT((J.transpose() * n - row_along(knot, q, n)).cwiseAbs().maxCoeff() < 1e-6);
        RC_ASSERT((J.transpose() * J - motion_of(knot, q)).norm() < 1e-6 * (1 + J.squaredNorm()));
        RC_ASSERT(numeric.rightCols<kStateDim - kLidarDim>().norm() == 0);
      },
      300);
}

TEST(EstimatorSweepPath, DeskewRecoversTheWorldOfASteadyCarrier) {
  // Given points of the world, each seen from where the carrier was when it was fired ...
  StateChance chance(13);
  const State begin = chance.state();
  const SweepPath path = path_of(propagate(begin, kSpan.seconds()));
  for (int i = 0; i < 500; ++i) {
    const Vector3d world = begin.p + chance.vector(15);
    const auto offset_ns = static_cast<std::uint32_t>(chance.uniform(0, 1) * kSpan_ns);
    const State then = propagate(begin, static_cast<double>(offset_ns) * 1e-9);
    const Vector3d q = then.R.transpose() * (world - then.p);
    // ... then the path takes them back; the tolerance is that of interpolation at this rate.
    ASSERT_LT((path.to_world(q, offset_ns) - world).norm(), 1e-3);
  }
}

TEST(EstimatorSweepPath, TheNearestKnotIsWithinHalfAnInterval) {
  const SweepPath path = path_of(StateChance(14).state());
  const double interval_s = kSpan.seconds() / SweepPath::kIntervals;
  for (std::uint32_t offset_ns = 0; offset_ns <= kSpan_ns; offset_ns += 333'333) {
    const double tau = kSpan.seconds() - offset_ns * 1e-9;
    EXPECT_LE(std::abs(path.nearest_knot(offset_ns).before_end_s - tau), 0.5001 * interval_s) << offset_ns;
  }
}

TEST(EstimatorSweepPath, ASweepThatIsAnInstantHasOnePose) {
  StateChance chance(15);
  const State end = chance.state();
  const SweepPath path = path_of(end, Duration());
  for (const std::uint32_t offset_ns : {0U, 1U, kSpan_ns, 0xFFFFFFFFU})
    EXPECT_LT((path.to_world(Vector3d(1, 2, 3), offset_ns) - end.pose() * Vector3d(1, 2, 3)).norm(), 1e-12);
}

TEST(EstimatorSweepPath, AnOffsetPastTheEndIsTakenAsTheEnd) {
  const SweepPath path = path_of(StateChance(16).state());
  const Vector3d q(4, -3, 2);
  EXPECT_EQ(path.to_world(q, 0xFFFFFFFFU), path.to_world(q, kSpan_ns));
  EXPECT_EQ(path.nearest_knot(0xFFFFFFFFU).before_end_s, 0);
}

}  // namespace
}  // namespace lxd::estimator_sweep_path_test
