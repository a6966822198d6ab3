// SPDX-License-Identifier: Apache-2.0
// What a scenario says of an IMU: how it errs, where it sits, and over which wire it speaks.
#pragma once

#include "board/yaml_section.hpp"
#include "drivers/imu/imu_protocol.hpp"
#include "rt/pose.hpp"
#include "rt/result.hpp"
#include "tools/simulator/clock.hpp"

namespace lxd::sim {

// A shake that the trajectory does not have: a sine on every axis, each with a phase of its own.
struct ImuVibration {
  double amplitude_mps2 = 0;
  double gyro_amplitude_radps = 0;
  double frequency_hz = 80;  // above half the update rate it is seen at its alias, as a sensor without filter sees it
};

// A serial port of the host: 8N1, and an adapter that hands bytes over when its buffer is full or its timer ticks.
struct SerialLineConfig {
  double baud_rate = 115200;
  double chunk_bytes = 62;      // data of one USB packet of the common adapters
  double chunk_timer_s = 1e-3;  // their latency timer, set to its least value as drivers for IMUs set it
};

// Noise in Kalibr's names and units, with the defaults of the rig file. What is drawn once for a recording (bias,
// scale, misalignment) is given by its standard deviation. The defaults of those are of an uncalibrated industrial
// MEMS.
struct ImuConfig {
  double update_rate = 200;                     // Hz, of the sensor's own clock
  double gyroscope_noise_density = 1.6968e-4;   // rad/s/sqrt(Hz)
  double accelerometer_noise_density = 2.0e-3;  // m/s^2/sqrt(Hz)
  double gyroscope_random_walk = 1.9393e-5;     // rad/s^2/sqrt(Hz)
  double accelerometer_random_walk = 3.0e-3;    // m/s^3/sqrt(Hz)
  double gyro_bias_radps = 2e-3;
  double accel_bias_mps2 = 0.05;
  double gyro_scale_ppm = 500;
  double accel_scale_ppm = 500;
  double misalignment_rad = 5e-4;  // of each axis towards each other
  double gyro_max_radps = 34.9;    // saturation: 2000 deg/s
  double accel_max_mps2 = 156.9;   // 16 g
  ImuVibration vibration;
  Pose T_body_sensor;
  ClockConfig clock;
  ImuProtocol protocol = ImuProtocol::kVectorNav;
  SerialLineConfig line;
};

// Its keys in a scenario; extrinsics and clock are read by whoever reads every sensor's.
void read_keys(YamlSection& section, ImuConfig& config);

// The same sensor without any error but the wire's number format.
ImuConfig without_errors(ImuConfig config);

}  // namespace lxd::sim
