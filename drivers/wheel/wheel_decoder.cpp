// SPDX-License-Identifier: Apache-2.0
// See wheel_decoder.hpp.
#include "drivers/wheel/wheel_decoder.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

constexpr std::array kMotion{CanRole::speed, CanRole::yaw_rate};
constexpr std::array kRearWheels{CanRole::rear_left, CanRole::rear_right};
constexpr std::array kOdometer{CanRole::odometer_left, CanRole::odometer_right};
constexpr std::array kSteering{CanRole::speed, CanRole::steering_angle};
constexpr std::array kFourWheels{CanRole::rear_left, CanRole::rear_right, CanRole::front_left, CanRole::front_right};

bool has(const CanMessage& message, CanRole role) {
  for (const CanSignal& signal : message.signals)
    if (signal.role == role) return true;
  return false;
}

// Counts wrap where their bits end.
double way(std::int64_t from, std::int64_t to, const CanSignal& signal) {
  const std::int64_t range = std::int64_t{1} << signal.bits;
  const std::int64_t forward = (to - from) & (range - 1);
  return static_cast<double>(forward < range / 2 ? forward : forward - range) * signal.scale;
}

}  // namespace

std::span<const CanRole> roles_of(WheelSource source) {
  switch (source) {
    case WheelSource::rear_wheels:
      return kRearWheels;
    case WheelSource::odometer:
      return kOdometer;
    case WheelSource::steering:
      return kSteering;
    case WheelSource::four_wheels:
      return kFourWheels;
    case WheelSource::motion:
      break;
  }
  return kMotion;
}

std::optional<WheelSample> WheelDecoder::decode(const CanFrame& frame) {
  const CanMessage* const message = accept(frame);
  if (message == nullptr) return std::nullopt;
  const CanValues values = decode_signals(*message, frame.data);
  if (values.fault) ++counts_.fault_bit;
  keep(*message, values, frame.received);
  if (!has(*message, roles_of(config_.source).front())) {
    ++counts_.other_frames;
    return std::nullopt;
  }
  if (!has_all_parts(frame.received)) {
    if (!values.fault) ++counts_.missing_part;
    return std::nullopt;
  }
  const std::optional<WheelSample> sample = sample_at(frame.received);
  if (!sample) return std::nullopt;
  if (!in_range(*sample)) {
    ++counts_.out_of_range;
    return std::nullopt;
  }
  ++counts_.samples;
  return sample;
}

const CanMessage* WheelDecoder::accept(const CanFrame& frame) {
  if (frame.kind == CanKind::error) {
    count_error(frame);
    return nullptr;
  }
  const CanMessage* const message = find_message(config_.messages, frame.id, frame.extended);
  if (message == nullptr) {
    ++counts_.unknown_id;
  } else if (frame.kind == CanKind::remote) {
    ++counts_.remote_frames;
  } else if (frame.length != message->length) {
    ++counts_.bad_length;
  } else if (!checksum_holds(*message, frame.data)) {
    ++counts_.bad_checksum;
  } else {
    return message;
  }
  return nullptr;
}

void WheelDecoder::count_error(const CanFrame& frame) {
  ++counts_.error_frames;
  if ((frame.id & kCanErrorBusOff) != 0) ++counts_.bus_off;
}

// A value whose fault bit is set is none: the one before it is not used in its place.
void WheelDecoder::keep(const CanMessage& message, const CanValues& values, RigTime received) {
  for (const CanSignal& signal : message.signals)
    parts_[static_cast<std::size_t>(signal.role)] = {values[signal.role], received};
}

bool WheelDecoder::has_all_parts(RigTime now) const {
  return std::ranges::all_of(roles_of(config_.source), [&](CanRole role) {
    const Part& part = parts_[static_cast<std::size_t>(role)];
    return part.value.known() && now - part.received <= config_.oldest_part;
  });
}

// Precondition: all parts are there.
std::optional<WheelSample> WheelDecoder::sample_at(RigTime received) {
  switch (config_.source) {
    case WheelSource::rear_wheels:
      return from_sides(value(CanRole::rear_left), value(CanRole::rear_right), received);
    case WheelSource::odometer:
      return from_odometer(received);
    case WheelSource::steering:
      return from_steering(received);
    case WheelSource::four_wheels:
      return from_four_wheels(received);
    case WheelSource::motion:
      break;
  }
  return WheelSample{received, value(CanRole::speed), value(CanRole::yaw_rate), {}};
}

// One steered wheel midway between those of the front axle: its axis meets that of the rear axle in the turn's centre.
WheelSample WheelDecoder::from_steering(RigTime received) const {
  const double speed_mps = value(CanRole::speed);
  return {received, speed_mps, speed_mps * std::tan(value(CanRole::steering_angle)) / config_.wheelbase_m, {}};
}

// A wheel of the front axle moves sideways with yaw rate times wheelbase, too: what is left of its speed is forward.
WheelSample WheelDecoder::from_four_wheels(RigTime received) const {
  const double rear_left = value(CanRole::rear_left), rear_right = value(CanRole::rear_right);
  const double sideways = (rear_right - rear_left) / config_.track_m * config_.wheelbase_m;
  const auto forward = [&](double speed) {
    return std::copysign(std::sqrt(std::max(0.0, speed * speed - sideways * sideways)), speed);
  };
  return from_sides((rear_left + forward(value(CanRole::front_left))) / 2,
                    (rear_right + forward(value(CanRole::front_right))) / 2, received);
}

std::optional<WheelSample> WheelDecoder::from_odometer(RigTime received) {
  const CanValue& left = parts_[static_cast<std::size_t>(CanRole::odometer_left)].value;
  const CanValue& right = parts_[static_cast<std::size_t>(CanRole::odometer_right)].value;
  const std::optional<Odometer> before = last_;
  last_ = {received, left.raw, right.raw};
  if (!before) return std::nullopt;
  const Duration since = received - before->received;
  if (since <= Duration() || since > config_.longest_gap) {
    ++counts_.gaps;
    return std::nullopt;
  }
  // The vehicle sends by its own timer: whole periods have passed, whatever the bus added to the receive times.
  const std::int64_t periods = std::max<std::int64_t>(1, (since + config_.period / 2).ns() / config_.period.ns());
  const Duration span = config_.period * periods;
  WheelSample sample = from_sides(way(before->left, last_->left, *left.signal) / span.seconds(),
                                  way(before->right, last_->right, *right.signal) / span.seconds(), received);
  sample.span = span;
  return sample;
}

WheelSample WheelDecoder::from_sides(double left_mps, double right_mps, RigTime received) const {
  return {received, (left_mps + right_mps) / 2, (right_mps - left_mps) / config_.track_m, {}};
}

bool WheelDecoder::in_range(const WheelSample& sample) const {
  return std::abs(sample.speed_mps) <= config_.speed_max_mps &&
         std::abs(sample.yaw_rate_radps) <= config_.yaw_rate_max_radps;
}

Rejections rejections_of(const WheelCounts& counts) {
  Rejections rejected;
  set_rejected(rejected, {{"bad_length", counts.bad_length},
                          {"bad_checksum", counts.bad_checksum},
                          {"fault_bit", counts.fault_bit},
                          {"out_of_range", counts.out_of_range},
                          {"missing_part", counts.missing_part},
                          {"error_frame", counts.error_frames},
                          {"bus_off", counts.bus_off}});
  return rejected;
}

}  // namespace lxd
