// SPDX-License-Identifier: Apache-2.0
// See wheel_decoder.hpp.
#include "drivers/wheel/wheel_decoder.hpp"

namespace lxd {
namespace {

bool has_sample(WheelSource source, const CanMessage& message) {
  const auto has = [&](CanRole role) {
    for (const CanSignal& signal : message.signals)
      if (signal.role == role) return true;
    return false;
  };
  switch (source) {
    case WheelSource::motion:
      return has(CanRole::speed) && has(CanRole::yaw_rate);
    case WheelSource::rear_wheels:
      return has(CanRole::rear_left) && has(CanRole::rear_right);
    case WheelSource::odometer:
      return has(CanRole::odometer_left) && has(CanRole::odometer_right);
  }
  return false;
}

// Counts wrap as int32 does.
double way(std::uint32_t from, std::uint32_t to, double scale) {
  return static_cast<double>(static_cast<std::int32_t>(to - from)) * scale;
}

}  // namespace

std::optional<WheelSample> WheelDecoder::decode(const CanFrame& frame) {
  const CanMessage* const message = accept(frame);
  if (message == nullptr) return std::nullopt;
  const CanValues values = decode_signals(*message, frame.data);
  if (values.fault) ++counts_.fault_bit;
  if (!has_sample(config_.source, *message)) {
    ++counts_.other_frames;
    return std::nullopt;
  }
  const std::optional<WheelSample> sample = sample_from(values, frame.received);
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
  const CanMessage* const message = frame.extended ? nullptr : find_message(config_.messages, frame.id);
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

std::optional<WheelSample> WheelDecoder::sample_from(const CanValues& values, RigTime received) {
  switch (config_.source) {
    case WheelSource::motion: {
      const CanValue& speed = values[CanRole::speed];
      const CanValue& yaw_rate = values[CanRole::yaw_rate];
      if (!speed.known() || !yaw_rate.known()) return std::nullopt;
      return WheelSample{received, speed.value(), yaw_rate.value(), {}};
    }
    case WheelSource::rear_wheels: {
      const CanValue& left = values[CanRole::rear_left];
      const CanValue& right = values[CanRole::rear_right];
      if (!left.known() || !right.known()) return std::nullopt;
      return from_sides(left.value(), right.value(), received);
    }
    case WheelSource::odometer:
      return from_odometer(values, received);
  }
  return std::nullopt;
}

std::optional<WheelSample> WheelDecoder::from_odometer(const CanValues& values, RigTime received) {
  const CanValue& left = values[CanRole::odometer_left];
  const CanValue& right = values[CanRole::odometer_right];
  if (!left.known() || !right.known()) return std::nullopt;
  const std::optional<Odometer> before = last_;
  last_ = {received, static_cast<std::uint32_t>(left.raw), static_cast<std::uint32_t>(right.raw)};
  if (!before) return std::nullopt;
  const Duration since = received - before->received;
  if (since <= Duration() || since > config_.longest_gap) {
    ++counts_.gaps;
    return std::nullopt;
  }
  // The vehicle sends by its own timer: whole periods have passed, whatever the bus added to the receive times.
  const std::int64_t periods = std::max<std::int64_t>(1, (since + config_.period / 2).ns() / config_.period.ns());
  const Duration span = config_.period * periods;
  WheelSample sample = from_sides(way(before->left, last_->left, left.signal->scale) / span.seconds(),
                                  way(before->right, last_->right, right.signal->scale) / span.seconds(), received);
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

}  // namespace lxd
