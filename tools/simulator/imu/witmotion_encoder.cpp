// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/witmotion_encoder.hpp"

#include <chrono>
#include <cmath>
#include <limits>

namespace lxd::sim {
namespace {

using FrameBytes = std::vector<std::uint8_t>;
using std::chrono::sys_days;
using std::chrono::year;

constexpr int kLastYear = 2255;
constexpr double kTemperature_degC = 25;
constexpr double kCentidegrees = 100;

FrameBytes begun(std::uint8_t id) {
  FrameBytes frame(kWitMotionFrameBytes);
  frame[0] = kWitMotionSync;
  frame[1] = id;
  return frame;
}

FrameBytes sealed(FrameBytes frame) {
  frame[kWitMotionChecksumAt] = witmotion_checksum(frame);
  return frame;
}

std::uint16_t quantized(double value, double unit) {
  constexpr double kLow = std::numeric_limits<std::int16_t>::min(), kHigh = std::numeric_limits<std::int16_t>::max();
  const double raw = std::isnan(value) ? kLow : std::clamp(std::round(value / unit), kLow, kHigh);
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(raw));
}

// Not a loop: in one, gcc 12 no longer sees that a field ends within the frame, and warns.
void put_axes(FrameBytes& frame, const Eigen::Vector3d& v, double unit) {
  witmotion::kAxes[0].set(frame.data(), quantized(v.x(), unit));
  witmotion::kAxes[1].set(frame.data(), quantized(v.y(), unit));
  witmotion::kAxes[2].set(frame.data(), quantized(v.z(), unit));
}

void append(FrameBytes& frames, const FrameBytes& frame) { frames.insert(frames.end(), frame.begin(), frame.end()); }

}  // namespace

bool is_witmotion_time(std::int64_t sensor_ns) {
  const std::chrono::sys_time<std::chrono::nanoseconds> time{std::chrono::nanoseconds(sensor_ns)};
  return time >= sys_days{year{witmotion::kFirstYear} / 1 / 1} && time < sys_days{year{kLastYear + 1} / 1 / 1};
}

FrameBytes encode_witmotion_time(std::int64_t sensor_ns) {
  namespace c = std::chrono;
  const c::sys_time<c::nanoseconds> time{c::nanoseconds(sensor_ns)};
  const auto day_start = c::floor<c::days>(time);
  const c::year_month_day date{day_start};
  const c::hh_mm_ss clock{c::floor<c::milliseconds>(time - day_start)};
  FrameBytes frame = begun(kWitMotionTime);
  namespace w = witmotion;
  w::kYear.set(frame.data(), static_cast<std::uint64_t>(static_cast<int>(date.year()) - w::kFirstYear));
  w::kMonth.set(frame.data(), static_cast<unsigned>(date.month()));
  w::kDay.set(frame.data(), static_cast<unsigned>(date.day()));
  w::kHour.set(frame.data(), static_cast<std::uint64_t>(clock.hours().count()));
  w::kMinute.set(frame.data(), static_cast<std::uint64_t>(clock.minutes().count()));
  w::kSecond.set(frame.data(), static_cast<std::uint64_t>(clock.seconds().count()));
  w::kMillisecond.set(frame.data(), static_cast<std::uint64_t>(clock.subseconds().count()));
  return sealed(std::move(frame));
}

FrameBytes encode_witmotion_acceleration(const Eigen::Vector3d& accel_mps2, double temperature_degC) {
  FrameBytes frame = begun(kWitMotionAcceleration);
  put_axes(frame, accel_mps2, kWitMotionAccelUnit_mps2);
  witmotion::kTemperature.set(frame.data(), quantized(temperature_degC, 1 / kCentidegrees));
  return sealed(std::move(frame));
}

FrameBytes encode_witmotion_rate(const Eigen::Vector3d& gyro_radps) {
  FrameBytes frame = begun(kWitMotionRate);
  put_axes(frame, gyro_radps, kWitMotionRateUnit_radps);
  return sealed(std::move(frame));
}

FrameBytes encode_witmotion(std::int64_t sensor_ns, const Inertial& sample) {
  FrameBytes frames = encode_witmotion_time(sensor_ns);
  append(frames, encode_witmotion_acceleration(sample.accel_mps2, kTemperature_degC));
  append(frames, encode_witmotion_rate(sample.gyro_radps));
  return frames;
}

}  // namespace lxd::sim
