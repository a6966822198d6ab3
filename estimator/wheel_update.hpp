// SPDX-License-Identifier: Apache-2.0
// Wheels as a measurement of the body's velocity (design 6.5): the wheel frame moves along its x only (non-holonomic)
// at the speed that the encoders say, and turns about its z at the rate that they say. The same with an IMU and
// without one: the body's rate is what the gyroscope measured (zero for the virtual one) less b_g.
//
//   v_wheel = C (R^T v + w x l),   w = w_m - b_g,   C = R_wheel_body,   l: the wheel frame's origin in the body
#pragma once

#include "estimator/ieskf.hpp"
#include "estimator/wheel_history.hpp"
#include "rt/pose.hpp"

namespace lxd {

struct WheelModel {
  Pose T_body_wheel;
  double speed_sigma_mps;       // of one reading
  double yaw_rate_sigma_radps;  // of one reading
  double delay_s = 0;           // an instant's reading is stamped so much later (wheel_alignment.hpp)
  double delay_sigma_s = 0;     // how sure that is; 0: exactly
};

using WheelMeasurement = Ieskf::Measurement<4>;  // forward, left, up, yaw rate

// gyro: the measured rate of the body at the reading's time; zero without an IMU.
WheelMeasurement wheel_measurement(const State& x, const WheelReading& reading, const WheelModel& model,
                                   const Eigen::Vector3d& gyro_radps);

// Takes a reading into the filter unless it slips: false when it is farther from the prediction than one of a thousand
// sound readings.
bool update_with_wheel(Ieskf& filter, const WheelReading& reading, const WheelModel& model,
                       const Eigen::Vector3d& gyro_radps);

}  // namespace lxd
