// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/witmotion_encoder.hpp"

#include <chrono>
#include <cmath>
#include <limits>

namespace lxd::sim {
namespace {

using Frame = std::vector<std::uint8_t>;
using std::chrono::sys_days;
using std::chrono::year;

constexpr int kLastYear = 2255;
constexpr double kTemperature_degC = 25;
constexpr double kCentidegrees = 100;

// Not inlined: gcc 12 takes the vectorised loop of set() for one that writes beyond the frame.
[[gnu::noinline]] void put(Frame& frame, const BitField& field, std::uint64_t value) { field.set(frame.data(), value); }

Frame begun(std::uint8_t id) {
  Frame frame(kWitMotionFrameBytes);
  frame[0] = kWitMotionSync;
  frame[1] = id;
  return frame;
}

Frame sealed(Frame frame) {
  frame[kWitMotionChecksumAt] = witmotion_checksum(frame);
  return frame;
}

std::uint16_t quantized(double value, double unit) {
  constexpr double kLow = std::numeric_limits<std::int16_t>::min(), kHigh = std::numeric_limits<std::int16_t>::max();
  const double raw = std::isnan(value) ? kLow : std::clamp(std::round(value / unit), kLow, kHigh);
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(raw));
}

void put_axes(Frame& frame, const Eigen::Vector3d& v, double unit) {
  for (int i = 0; i < 3; ++i) put(frame, witmotion::kAxes[i], quantized(v[i], unit));
}

void append(Frame& frames, const Frame& frame) { frames.insert(frames.end(), frame.begin(), frame.end()); }

}  // namespace

bool is_witmotion_time(std::int64_t sensor_ns) {
  const std::chrono::sys_time<std::chrono::nanoseconds> time{std::chrono::nanoseconds(sensor_ns)};
  return time >= sys_days{year{witmotion::kFirstYear} / 1 / 1} && time < sys_days{year{kLastYear + 1} / 1 / 1};
}

Frame encode_witmotion_time(std::int64_t sensor_ns) {
  namespace c = std::chrono;
  const c::sys_time<c::nanoseconds> time{c::nanoseconds(sensor_ns)};
  const auto day_start = c::floor<c::days>(time);
  const c::year_month_day date{day_start};
  const c::hh_mm_ss clock{c::floor<c::milliseconds>(time - day_start)};
  Frame frame = begun(kWitMotionTime);
  namespace w = witmotion;
  put(frame, w::kYear, static_cast<std::uint64_t>(static_cast<int>(date.year()) - w::kFirstYear));
  put(frame, w::kMonth, static_cast<unsigned>(date.month()));
  put(frame, w::kDay, static_cast<unsigned>(date.day()));
  put(frame, w::kHour, static_cast<std::uint64_t>(clock.hours().count()));
  put(frame, w::kMinute, static_cast<std::uint64_t>(clock.minutes().count()));
  put(frame, w::kSecond, static_cast<std::uint64_t>(clock.seconds().count()));
  put(frame, w::kMillisecond, static_cast<std::uint64_t>(clock.subseconds().count()));
  return sealed(std::move(frame));
}

Frame encode_witmotion_acceleration(const Eigen::Vector3d& accel_mps2, double temperature_degC) {
  Frame frame = begun(kWitMotionAcceleration);
  put_axes(frame, accel_mps2, kWitMotionAccelUnit_mps2);
  put(frame, witmotion::kTemperature, quantized(temperature_degC, 1 / kCentidegrees));
  return sealed(std::move(frame));
}

Frame encode_witmotion_rate(const Eigen::Vector3d& gyro_radps) {
  Frame frame = begun(kWitMotionRate);
  put_axes(frame, gyro_radps, kWitMotionRateUnit_radps);
  return sealed(std::move(frame));
}

Frame encode_witmotion(std::int64_t sensor_ns, const Inertial& sample) {
  Frame frames = encode_witmotion_time(sensor_ns);
  append(frames, encode_witmotion_acceleration(sample.accel_mps2, kTemperature_degC));
  append(frames, encode_witmotion_rate(sample.gyro_radps));
  return frames;
}

}  // namespace lxd::sim
