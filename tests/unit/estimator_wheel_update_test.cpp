// SPDX-License-Identifier: Apache-2.0
// Wheels as a measurement: H against numeric differentiation, what a reading says with an IMU and without one, which
// readings slip, and how sure many of them make.
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/wheel_update.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_wheel_update_test {
namespace {

using Eigen::Vector3d;
using test::check_property;
using test::StateChance;

constexpr double kGate = 18.47;         // chi-square, 4 degrees of freedom, 0.999
constexpr double kSharedReadings = 10;  // tell no more than one

// The wheels' frame is anywhere on the body and looks anywhere.
WheelModel model_at(const Pose& T_body_wheel) { return {T_body_wheel, 0.02, 0.02}; }
Pose any_pose(StateChance& chance) { return {Exp(chance.vector(1)), chance.vector(1)}; }
WheelModel plain_model() { return model_at(Pose{}); }

// What wheels say that roll without slip: along x of their frame.
WheelReading reading_of(const State& x, const WheelModel& model, const Vector3d& gyro) {
  const Vector3d rate = gyro - x.b_g;
  const Vector3d v = x.R.transpose() * x.v + rate.cross(model.T_body_wheel.p);
  return {RigTime(), (model.T_body_wheel.R.transpose() * v).x(), (model.T_body_wheel.R.transpose() * rate).z()};
}

// A robot that drives ahead at 2 m/s and turns left at 0.5 rad/s, told by an IMU's bias or by the virtual gyroscope.
State driving() {
  State x;
  x.R = Exp(Vector3d(0, 0, 1));
  x.v = x.R * Vector3d(2, 0, 0);
  x.b_g = {0, 0, -0.5};
  return x;
}

StateMatrix doubt(double speed_mps, double rate_radps) {
  StateMatrix P = StateMatrix::Zero();
  P.diagonal().head<3>().setConstant(1e-6);
  P.diagonal().segment<3>(kVelocity).setConstant(speed_mps * speed_mps);
  P.diagonal().segment<3>(kGyroBias).setConstant(rate_radps * rate_radps);
  return P;
}

Ieskf filter_of(const State& x, const StateMatrix& P) {
  Ieskf filter;
  filter.reset(x, P);
  return filter;
}

TEST(EstimatorWheelUpdate, HAgreesWithNumericDifferentiation) {
  check_property(
      [] {
        StateChance chance(*rc::gen::arbitrary<unsigned>());
        const State x = chance.state();
        const WheelModel model = model_at(any_pose(chance));
        const Vector3d gyro = chance.vector(1);
        const WheelReading reading{RigTime(), chance.normal(3), chance.normal(1)};
        const auto numeric = test::numeric_jacobian<4>(
            x, [&](const State& at) { return wheel_measurement(at, reading, model, gyro).r; });
        RC_ASSERT((numeric - wheel_measurement(x, reading, model, gyro).H).cwiseAbs().maxCoeff() < 1e-6);
      },
      300);
}

TEST(EstimatorWheelUpdate, ACarrierThatRollsHasNoResidual) {
  // Given wheels half a metre behind the body and turned by 0.3 rad, and a body that rolls along their x ...
  const WheelModel model = model_at({Exp(Vector3d(0, 0, 0.3)), {-0.5, 0.2, -0.4}});
  State x;
  x.b_g = {0, 0, 0.02};
  const Vector3d gyro(0, 0, 0.72), rate(0, 0, 0.7);
  x.v = model.T_body_wheel.R * Vector3d(1.5, 0, 0) - rate.cross(model.T_body_wheel.p);
  // ... then what they say is what the state expects, lever included.
  const WheelReading reading{RigTime(), 1.5, 0.7};
  EXPECT_LT(wheel_measurement(x, reading, model, gyro).r.norm(), 1e-12);
  x.v = Vector3d(1.5, 0, 0);
  EXPECT_GT(wheel_measurement(x, reading, model, gyro).r.norm(), 0.1);
}

TEST(EstimatorWheelUpdate, ASpeedIsTakenForwardsAndSidewaysThereIsNone) {
  // Given a prior that knows the heading and nothing of the speed ...
  State x = driving();
  x.v = x.R * Vector3d(0, 1, -1);
  Ieskf filter = filter_of(x, doubt(2, 0.1));
  ASSERT_TRUE(update_with_wheel(filter, {RigTime(), 2, 0.5}, plain_model(), Vector3d::Zero()));
  // ... then it drives ahead, and not to the side or up.
  const Vector3d v_body = x.R.transpose() * filter.state().v;
  EXPECT_NEAR(v_body.x(), 2, 0.02);
  EXPECT_NEAR(v_body.y(), 0, 0.05);
  EXPECT_NEAR(v_body.z(), 0, 0.05);
  EXPECT_LT(filter.covariance().diagonal().segment<3>(kVelocity).maxCoeff(), 0.2);
}

TEST(EstimatorWheelUpdate, WithoutAnImuTheYawRateIsTheBodys) {
  State x = driving();
  x.b_g.setZero();
  Ieskf filter = filter_of(x, doubt(0.1, 0.5));
  ASSERT_TRUE(update_with_wheel(filter, {RigTime(), 2, 0.5}, plain_model(), Vector3d::Zero()));
  EXPECT_NEAR(-filter.state().b_g.z(), 0.5, 0.02);
  EXPECT_NEAR(filter.state().b_g.x(), 0, 1e-9);  // of roll and pitch they say nothing
}

TEST(EstimatorWheelUpdate, WithAnImuTheYawRateTellsTheGyroscopesBias) {
  State x = driving();
  x.b_g.setZero();
  Ieskf filter = filter_of(x, doubt(0.1, 0.5));
  ASSERT_TRUE(update_with_wheel(filter, {RigTime(), 2, 0.5}, plain_model(), {0, 0, 0.53}));
  EXPECT_NEAR(filter.state().b_g.z(), 0.03, 0.005);
}

// One reading's surprise grows with the square of what it is off by: it is taken up to the gate and not beyond.
TEST(EstimatorWheelUpdate, AReadingSlipsBeyondTheGateAndLeavesTheFilterAlone) {
  const State x = driving();
  const StateMatrix P = doubt(0.05, 0.02);
  const auto surprise = [&](double off_mps) {
    return filter_of(x, P).surprise(
        wheel_measurement(x, {RigTime(), 2 + off_mps, 0.5}, plain_model(), Vector3d::Zero()));
  };
  double low = 0, high = 2;
  for (int i = 0; i < 60; ++i) (surprise((low + high) / 2) < kGate ? low : high) = (low + high) / 2;
  EXPECT_NEAR(low, std::sqrt(kGate * (0.05 * 0.05 + 0.02 * 0.02 + 0.02 * 0.02)), 0.02);  // the scale is 1 % of 2 m/s
  for (const double share : {0.999, 1.001}) {
    Ieskf filter = filter_of(x, P);
    EXPECT_EQ(update_with_wheel(filter, {RigTime(), 2 + share * low, 0.5}, plain_model(), Vector3d::Zero()), share < 1);
    EXPECT_EQ(boxminus(filter.state(), x).norm() == 0, share > 1);
    EXPECT_EQ(filter.covariance() == P, share > 1);
  }
}

TEST(EstimatorWheelUpdate, AReadingThatIsNoNumberSlips) {
  const State x = driving();
  Ieskf filter = filter_of(x, doubt(1, 1));
  EXPECT_FALSE(update_with_wheel(filter, {RigTime(), std::nan(""), 0.5}, plain_model(), Vector3d::Zero()));
  EXPECT_FALSE(update_with_wheel(filter, {RigTime(), 2, INFINITY}, plain_model(), Vector3d::Zero()));
  EXPECT_EQ(boxminus(filter.state(), x).norm(), 0);
}

TEST(EstimatorWheelUpdate, ManyReadingsAreAsSureAsATenthOfThem) {
  for (const int count : {10, 100, 1000}) {
    const State x = driving();
    Ieskf filter = filter_of(x, doubt(100, 100));
    for (int i = 0; i < count; ++i)
      ASSERT_TRUE(update_with_wheel(filter, {RigTime(), 2, 0.5}, plain_model(), Vector3d::Zero()));
    const double told = count / kSharedReadings;
    const Vector3d forward = x.R.col(0);
    const double variance = forward.dot(filter.covariance().block<3, 3>(kVelocity, kVelocity) * forward);
    EXPECT_NEAR(variance * told / (2 * 0.02 * 0.02), 1, 0.01) << count;
    EXPECT_NEAR(filter.covariance()(kGyroBias + 2, kGyroBias + 2) * told / (0.02 * 0.02), 1, 0.01) << count;
  }
}

TEST(EstimatorWheelUpdate, FastWheelsAreTrustedLessByTheirTyresScale) {
  const auto forward_variance = [](double speed_mps) {
    return wheel_measurement(State{}, {RigTime(), speed_mps, 0}, plain_model(), Vector3d::Zero()).R(0, 0);
  };
  EXPECT_NEAR(forward_variance(0), 4e-4, 1e-12);
  EXPECT_NEAR(forward_variance(20), 4e-4 + 0.04, 1e-9);
  EXPECT_EQ(forward_variance(-20), forward_variance(20));
}

TEST(EstimatorWheelUpdate, WhatRollsIsWhatItSays) {
  check_property(
      [] {
        StateChance chance(*rc::gen::arbitrary<unsigned>());
        const State x = chance.state();
        const WheelModel model = model_at(any_pose(chance));
        const Vector3d gyro = chance.vector(1);
        const WheelMeasurement m = wheel_measurement(x, reading_of(x, model, gyro), model, gyro);
        RC_ASSERT(std::abs(m.r[0]) < 1e-10);
        RC_ASSERT(std::abs(m.r[3]) < 1e-10);
      },
      200);
}

}  // namespace
}  // namespace lxd::estimator_wheel_update_test
