// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/imu_config.hpp"

#include <limits>
#include <string>

namespace lxd::sim {
namespace {

// Ranges: what sensors on the market do, with room on both sides. 0 switches an error off.
constexpr ValueRange kSampleRates{10, 2000, "Hz", "is it a period?"};
constexpr ValueRange kGyroNoise{0, 1, "rad/s/sqrt(Hz)", "is it in degrees?"};
constexpr ValueRange kAccelNoise{0, 1, "m/s^2/sqrt(Hz)", "is it in micro-g?"};
constexpr ValueRange kGyroWalk{0, 1, "rad/s^2/sqrt(Hz)", "is it in degrees an hour?"};
constexpr ValueRange kAccelWalk{0, 1, "m/s^3/sqrt(Hz)", "is it in micro-g?"};
constexpr ValueRange kGyroBias{0, 1, "rad/s", "is it in degrees a second?"};
constexpr ValueRange kAccelBias{0, 10, "m/s^2", "is it in milli-g?"};
constexpr ValueRange kScale{0, 100'000, "ppm", ""};
constexpr ValueRange kMisalignment{0, 0.2, "rad", "is it in degrees?"};
constexpr ValueRange kGyroMax{0.1, 200, "rad/s", "is it in degrees a second?"};
constexpr ValueRange kAccelMax{1, 10'000, "m/s^2", ""};
constexpr ValueRange kVibration{0, 1000, "m/s^2", ""};
constexpr ValueRange kGyroVibration{0, 100, "rad/s", "is it in degrees a second?"};
constexpr ValueRange kFrequency{0.1, 5000, "Hz", ""};
constexpr ValueRange kBaudRates{1200, 4'000'000, "baud", ""};
constexpr ValueRange kChunk{1, 4096, "bytes", ""};
constexpr ValueRange kTimer{1e-4, 0.1, "s", "is it in milliseconds?"};

}  // namespace

void read_keys(YamlSection& section, ImuConfig& config) {
  section.read("update_rate", config.update_rate, kSampleRates);
  section.read("gyroscope_noise_density", config.gyroscope_noise_density, kGyroNoise);
  section.read("accelerometer_noise_density", config.accelerometer_noise_density, kAccelNoise);
  section.read("gyroscope_random_walk", config.gyroscope_random_walk, kGyroWalk);
  section.read("accelerometer_random_walk", config.accelerometer_random_walk, kAccelWalk);
  section.read("gyro_bias_radps", config.gyro_bias_radps, kGyroBias);
  section.read("accel_bias_mps2", config.accel_bias_mps2, kAccelBias);
  section.read("gyro_scale_ppm", config.gyro_scale_ppm, kScale);
  section.read("accel_scale_ppm", config.accel_scale_ppm, kScale);
  section.read("misalignment_rad", config.misalignment_rad, kMisalignment);
  section.read("gyro_max_radps", config.gyro_max_radps, kGyroMax);
  section.read("accel_max_mps2", config.accel_max_mps2, kAccelMax);
  section.read("vibration_mps2", config.vibration.amplitude_mps2, kVibration);
  section.read("vibration_radps", config.vibration.gyro_amplitude_radps, kGyroVibration);
  section.read("vibration_hz", config.vibration.frequency_hz, kFrequency);
  std::string protocol{name_of(config.protocol)};
  section.read("protocol", protocol, kImuProtocolNames);
  if (const auto protocol_found = find_imu_protocol(protocol)) config.protocol = *protocol_found;
  section.read("baud_rate", config.line.baud_rate, kBaudRates);
  section.read("chunk_bytes", config.line.chunk_bytes, kChunk);
  section.read("chunk_timer_s", config.line.chunk_timer_s, kTimer);
}

ImuConfig without_errors(ImuConfig config) {
  config.gyroscope_noise_density = config.accelerometer_noise_density = 0;
  config.gyroscope_random_walk = config.accelerometer_random_walk = 0;
  config.gyro_bias_radps = config.accel_bias_mps2 = 0;
  config.gyro_scale_ppm = config.accel_scale_ppm = config.misalignment_rad = 0;
  config.gyro_max_radps = config.accel_max_mps2 = std::numeric_limits<double>::infinity();
  config.vibration = {};
  return config;
}

}  // namespace lxd::sim
