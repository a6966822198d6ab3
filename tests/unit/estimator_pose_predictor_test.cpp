// SPDX-License-Identifier: Apache-2.0
// The state between sweeps: how true it is at the rate of the IMU, and when there is none.
#include <gtest/gtest.h>

#include "estimator/pose_predictor.hpp"
#include "tests/support/inertial_motion.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::estimator_pose_predictor_test {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod_s = 0.005;
const Vector3d kGyroBias{0.01, -0.02, 0.03}, kAccelBias{0.1, -0.05, 0.2};

class EstimatorPosePredictor : public testing::Test {
 protected:
  [[nodiscard]] InertialReading biased(double t_s) const {
    InertialReading reading = motion_.reading(t_s);
    reading.rate_radps += kGyroBias;
    reading.force_mps2 += kAccelBias;
    return reading;
  }
  [[nodiscard]] MotionAnchor anchor(double t_s, bool inertial = true) const {
    State x = motion_.state(t_s);
    x.b_g = kGyroBias;
    x.b_a = kAccelBias;
    return MotionAnchor::of(RigTime::from_seconds(t_s), x, inertial, true);
  }
  // The last prediction of the readings in [from, to).
  std::optional<PredictedState> read(double from_s, double to_s) {
    std::optional<PredictedState> last;
    for (int i = static_cast<int>(std::round(from_s / kPeriod_s)); i * kPeriod_s < to_s - kPeriod_s / 2; ++i)
      last = predictor_.add(biased(i * kPeriod_s));
    return last;
  }

  test::InertialMotion motion_ = test::walking_about();
  test::OwnedArena arena_{std::size_t{1} << 20};
  PosePredictor predictor_{*arena_};
};

// Given a state of the filter that comes a tenth of a second late, when readings of 200 Hz go on, then each has its
// pose, and that is the motion's within a millimetre.
TEST_F(EstimatorPosePredictor, FollowsTheMotionFromALateState) {
  double worst_m = 0, worst_rad = 0;
  int predicted = 0;
  for (int i = 0; i < 1200; ++i) {
    const double t_s = 1 + i * kPeriod_s;
    if (i >= 40 && i % 20 == 0) predictor_.take(anchor(t_s - 0.1003));  // between two readings
    const auto now = predictor_.add(biased(t_s));
    if (!now) continue;
    ++predicted;
    worst_m = std::max(worst_m, (now->x.p - motion_.pose(t_s).p).norm());
    worst_rad = std::max(worst_rad, Log(motion_.pose(t_s).R.transpose() * now->x.R).norm());
    EXPECT_LT((now->rate_radps - motion_.rate(t_s)).norm(), 1e-3);
    EXPECT_TRUE(now->tracked);
  }
  EXPECT_EQ(predicted, 1160);
  EXPECT_LT(worst_m, 0.001);
  EXPECT_LT(worst_rad, 0.001);
}

// Given readings that are stamped late, and a state that knows by how much, then each pose is of the reading's instant.
TEST_F(EstimatorPosePredictor, TakesAReadingForWhatItWasWhenItWasTaken) {
  constexpr double kLate_s = 0.012;
  for (int i = 0; i < 100; ++i) {
    InertialReading late = biased(2 + i * kPeriod_s);
    late.t = late.t + Duration::from_seconds(kLate_s);
    if (i == 60) {
      MotionAnchor known = anchor(2.25);
      known.imu_delay = Duration::from_seconds(kLate_s);
      predictor_.take(known);
    }
    const auto now = predictor_.add(late);
    ASSERT_EQ(now.has_value(), i >= 60) << i;
    if (!now) continue;
    EXPECT_NEAR(now->t.seconds(), 2 + i * kPeriod_s, 1e-9);
    EXPECT_LT((now->x.p - motion_.pose(now->t.seconds()).p).norm(), 0.001);
  }
}

TEST_F(EstimatorPosePredictor, SaysNothingBeforeTheFilterDoesOrWithoutTheImusBiases) {
  EXPECT_FALSE(read(1, 1.2));
  predictor_.take(anchor(1.15, false));
  EXPECT_FALSE(read(1.2, 1.3));
  predictor_.take(anchor(1.25));
  EXPECT_TRUE(read(1.3, 1.4));
}

TEST_F(EstimatorPosePredictor, ReachesAsFarAsItSaysAndNoFarther) {
  (void)read(1, 1.5);
  predictor_.take(anchor(1.5));
  const double reach_s = PosePredictor::kReachMax.seconds();
  EXPECT_TRUE(read(1.5, 1.5 + reach_s));
  EXPECT_TRUE(predictor_.add(biased(1.5 + reach_s)));
  EXPECT_FALSE(predictor_.add(biased(1.5 + reach_s + kPeriod_s)));
}

// Given readings that are missing since the state, then nothing is made up; a newer state mends it.
TEST_F(EstimatorPosePredictor, DoesNotBridgeMissingReadings) {
  (void)read(1, 1.2);
  predictor_.take(anchor(1.19));
  EXPECT_FALSE(read(1.3, 1.35));
  predictor_.take(anchor(1.32));
  EXPECT_TRUE(read(1.35, 1.4));
}

// A reading that the history refuses has no pose of its own.
TEST_F(EstimatorPosePredictor, RefusesAReadingOfThePast) {
  (void)read(1, 1.2);
  predictor_.take(anchor(1.1));
  EXPECT_TRUE(read(1.2, 1.25));
  EXPECT_FALSE(predictor_.add(biased(1.21)));
  EXPECT_TRUE(predictor_.add(biased(1.25)));
}

}  // namespace
}  // namespace lxd::estimator_pose_predictor_test
