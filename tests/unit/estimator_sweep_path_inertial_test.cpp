// SPDX-License-Identifier: Apache-2.0
// The body's path along an IMU's readings: it is the propagation backwards, its knots are exact, and how points on it
// move with the end state is what numeric differentiation says.
#include <vector>

#include <gtest/gtest.h>

#include "estimator/sweep_path.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_sweep_path_inertial_test {
namespace {

using Eigen::Vector3d;
using test::check_property;
using test::StateChance;

constexpr double kReading_s = 0.005, kRateMax_radps = 6, kForceMax_mps2 = 20;

StateChance any_chance() { return StateChance(*rc::gen::arbitrary<unsigned>()); }

// A carrier's state at the begin of readings, and its states at each one's end.
struct InertialWay {
  explicit InertialWay(StateChance& chance, int count = 20) {
    State x = chance.state();
    x.p = chance.vector(1);
    x.b_g = chance.vector(0.05);
    states.push_back(x);
    for (int i = 0; i < count; ++i) {
      readings.push_back({kReading_s, chance.uniform(0, kRateMax_radps) * chance.direction(),
                          chance.uniform(0, kForceMax_mps2) * chance.direction()});
      states.push_back(propagate(states.back(), readings.back()));
    }
  }
  [[nodiscard]] const State& end() const { return states.back(); }
  [[nodiscard]] double span_s() const { return kReading_s * static_cast<double>(readings.size()); }

  std::vector<InertialSpan> readings;
  std::vector<State> states;
};

// What the forces' two placings, from the begin of a reading and from its end, differ by: w^2 f t^4 / 72 in each.
double placing_m(std::size_t readings) {
  return static_cast<double>(readings) * 1.5 * kRateMax_radps * kRateMax_radps * kForceMax_mps2 *
         std::pow(kReading_s, 4) / 72;
}

TEST(EstimatorSweepPathInertial, ThePathIsThePropagationBackwards) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const InertialWay way(chance);
        for (std::size_t i = 0; i < way.states.size(); ++i) {
          const double tau = way.span_s() - kReading_s * static_cast<double>(i);
          const PathKnot knot = SweepPath::knot(way.end(), tau, way.readings);
          RC_ASSERT((knot.R - way.states[i].R).norm() < 1e-12);
          RC_ASSERT((knot.p - way.states[i].p).norm() < placing_m(way.readings.size()) + 1e-12);
        }
      },
      100);
}

TEST(EstimatorSweepPathInertial, WithinAReadingItIsWhereAPartOfItLeads) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const InertialWay way(chance);
        const auto i = static_cast<std::size_t>(chance.uniform(0, 19.99));
        InertialSpan part = way.readings[i];
        part.span_s = chance.uniform(0, kReading_s);
        const State then = propagate(way.states[i], part);
        const double tau = way.span_s() - kReading_s * static_cast<double>(i) - part.span_s;
        const PathKnot knot = SweepPath::knot(way.end(), tau, way.readings);
        // Half a reading's mean force is its own, not the whole one's: third order in the velocity.
        const double third_order_m = kRateMax_radps * kRateMax_radps * kForceMax_mps2 * std::pow(kReading_s, 4) / 24;
        RC_ASSERT((knot.R - then.R).norm() < 1e-12);
        RC_ASSERT((knot.p - then.p).norm() < third_order_m + placing_m(20) + 1e-12);
      },
      200);
}

TEST(EstimatorSweepPathInertial, HowAPointMovesWithTheEndStateAgreesWithNumericDifferentiation) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const InertialWay way(chance);
        const double tau = chance.uniform(0, way.span_s());
        const Vector3d q = chance.vector(10), n = chance.direction();
        const auto numeric = test::numeric_jacobian<3>(way.end(), [&](const State& x) -> Vector3d {
          const PathKnot k = SweepPath::knot(x, tau, way.readings);
          return k.R * q + k.p;
        });
        const PathKnot knot = SweepPath::knot(way.end(), tau, way.readings);
        const Eigen::Matrix<double, 3, kLidarDim> J = numeric.leftCols<kLidarDim>();
        RC_ASSERT((J.transpose() * n - row_along(knot, q, n)).cwiseAbs().maxCoeff() < 1e-6);
        RC_ASSERT((J.transpose() * J - motion_of(knot, q)).norm() < 1e-6 * (1 + J.squaredNorm()));
        // What a row leaves out, b_a and g, moves the point by no more than half the time's square.
        RC_ASSERT((numeric.middleCols<3>(kAccelBias).colwise().norm().maxCoeff() < tau * tau / 2 + 1e-8));
        RC_ASSERT((numeric.middleCols<3>(kGravity) - tau * tau / 2 * Eigen::Matrix3d::Identity()).norm() < 1e-8);
      },
      300);
}

// The bias moves the lever, too: of a point at the body itself nothing else is left.
TEST(EstimatorSweepPathInertial, TheGyroscopesBiasTurnsTheForce) {
  StateChance chance(61);
  const InertialWay way(chance);
  const PathKnot knot = SweepPath::knot(way.end(), way.span_s(), way.readings);
  const double step = 1e-5;
  State less = way.end(), more = way.end();
  less.b_g.y() -= step;
  more.b_g.y() += step;
  const Vector3d numeric = (SweepPath::knot(more, way.span_s(), way.readings).lever -
                            SweepPath::knot(less, way.span_s(), way.readings).lever) /
                           (2 * step);
  EXPECT_GT(numeric.norm(), 1e-4);
  EXPECT_LT((knot.lever_by_bias.col(1) - numeric).norm(), 1e-7);
}

TEST(EstimatorSweepPathInertial, TheKnotsAreTheExactOnes) {
  StateChance chance(62);
  const InertialWay way(chance);
  SweepPath path;
  const Duration span = Duration::from_seconds(way.span_s());
  path.set(way.end(), span, way.readings);
  for (int i = 0; i <= SweepPath::kIntervals; ++i) {
    const auto offset_ns = static_cast<std::uint32_t>(span.ns() * i / SweepPath::kIntervals);
    const PathKnot& knot = path.nearest_knot(offset_ns);
    const PathKnot exact = SweepPath::knot(way.end(), knot.before_end_s, way.readings);
    EXPECT_NEAR(knot.before_end_s, way.span_s() * (SweepPath::kIntervals - i) / SweepPath::kIntervals, 1e-9);
    EXPECT_LT((knot.R - exact.R).norm() + (knot.p - exact.p).norm(), 1e-12) << i;
    EXPECT_LT((knot.turn - exact.turn).norm() + (knot.turn_by_bias - exact.turn_by_bias).norm(), 1e-12) << i;
    EXPECT_LT((knot.lever - exact.lever).norm() + (knot.lever_by_bias - exact.lever_by_bias).norm(), 1e-12) << i;
  }
}

TEST(EstimatorSweepPathInertial, BetweenKnotsPointsAreWhereTheExactPathHasThem) {
  // Given 5 rad/s, the fastest that the header's bound speaks of, and 100 m/s^2 ...
  StateChance chance(63);
  const Vector3d rate = 5 * chance.direction();
  const std::vector<InertialSpan> readings(20, {kReading_s, rate, 100 * chance.direction()});
  State end = chance.state();
  end.b_g.setZero();
  SweepPath path;
  path.set(end, Duration::from_ns(100'000'000), readings);
  for (int i = 0; i < 500; ++i) {
    const Vector3d q = 30 * chance.direction();
    const auto offset_ns = static_cast<std::uint32_t>(chance.uniform(0, 0.999e8));
    const PathKnot exact = SweepPath::knot(end, 0.1 - offset_ns * 1e-9, readings);
    // ... then the error is 8e-6 of the distance, the acceleration's share of the interval, and float's of the time.
    const double bent_m = 110 * std::pow(0.1 / SweepPath::kIntervals, 2) / 8;
    const double time_m = 1e-8 * (5 * 30 + end.v.norm() + 10);
    ASSERT_LT((path.to_world(q, offset_ns) - (exact.R * q + exact.p)).norm(), 8e-6 * 30 + bent_m + time_m);
  }
}

TEST(EstimatorSweepPathInertial, AnInstantWithoutReadingsHasOnePose) {
  const State end = StateChance(64).state();
  SweepPath path;
  path.set(end, Duration(), {});
  for (const std::uint32_t offset_ns : {0U, 1'000'000U})
    EXPECT_LT((path.to_world(Vector3d(1, 2, 3), offset_ns) - end.pose() * Vector3d(1, 2, 3)).norm(), 1e-12);
}

// Nanoseconds of rounding beyond the first reading are held at its values.
TEST(EstimatorSweepPathInertial, ALittleBeforeTheFirstReadingItGoesOn) {
  StateChance chance(65);
  const InertialWay way(chance);
  const PathKnot at = SweepPath::knot(way.end(), way.span_s(), way.readings);
  const PathKnot before = SweepPath::knot(way.end(), way.span_s() + 1e-6, way.readings);
  EXPECT_LT((before.p - at.p + 1e-6 * way.states.front().v).norm(), 1e-8);
  EXPECT_NEAR(Log(before.R.transpose() * at.R).norm(), 1e-6 * (way.readings.front().rate_radps - way.end().b_g).norm(),
              1e-9);
}

}  // namespace
}  // namespace lxd::estimator_sweep_path_inertial_test
