// SPDX-License-Identifier: Apache-2.0
#include "estimator/wheel_update.hpp"

#include <cmath>

#include "rt/square.hpp"

namespace lxd {
namespace {

// How far a wheeled carrier moves off its x: tyres that drift in a turn, suspensions, the unevenness of the ground.
constexpr double kSidewaysSigma_mps = 0.05, kUpwardsSigma_mps = 0.1;
constexpr double kSpeedScaleSigma = 0.01;  // tyres' radius: share of the speed
// Errors of consecutive readings have the same cause (a tyre, a slope) for about so many readings: together they tell
// no more than one.
constexpr double kSharedReadings = 10;
constexpr double kGate = 18.47;  // chi-square, 4 degrees of freedom, 0.999

}  // namespace

WheelMeasurement wheel_measurement(const State& x, const WheelReading& reading, const WheelModel& model,
                                   const Eigen::Vector3d& gyro_radps) {
  const Eigen::Matrix3d C = model.T_body_wheel.R.transpose();
  const Eigen::Vector3d& l = model.T_body_wheel.p;
  const Eigen::Vector3d v_body = x.R.transpose() * x.v, rate = gyro_radps - x.b_g;
  WheelMeasurement m;
  m.r.head<3>() = C * (v_body + rate.cross(l)) - Eigen::Vector3d(reading.speed_mps, 0, 0);
  m.r[3] = C.row(2).dot(rate) - reading.yaw_rate_radps;
  m.H.block<3, 3>(0, kTheta) = C * hat(v_body);
  m.H.block<3, 3>(0, kVelocity) = C * x.R.transpose();
  m.H.block<3, 3>(0, kGyroBias) = C * hat(l);
  m.H.block<1, 3>(3, kGyroBias) = -C.row(2);
  m.R.diagonal() << square(model.speed_sigma_mps) + square(kSpeedScaleSigma * reading.speed_mps),
      square(kSidewaysSigma_mps), square(kUpwardsSigma_mps), square(model.yaw_rate_sigma_radps);
  return m;
}

bool update_with_wheel(Ieskf& filter, const WheelReading& reading, const WheelModel& model,
                       const Eigen::Vector3d& gyro_radps) {
  WheelMeasurement m = wheel_measurement(filter.state(), reading, model, gyro_radps);
  if (!(filter.surprise(m) <= kGate)) return false;
  m.R *= kSharedReadings;
  filter.correct(m);
  return true;
}

}  // namespace lxd
