// SPDX-License-Identifier: Apache-2.0
#include "drivers/imu/witmotion_parser.hpp"

#include <algorithm>
#include <chrono>

namespace lxd {
namespace {

using Bytes = std::span<const std::uint8_t>;

Eigen::Vector3d axes_of(Bytes frame, double unit) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = unit * static_cast<std::int16_t>(witmotion::kAxes[i].get(frame.data()));
  return v;
}

// The module's clock as if it were UTC, since 1970; none: no date.
std::optional<std::int64_t> time_of(Bytes frame) {
  namespace w = witmotion;
  namespace c = std::chrono;
  const auto part = [&](const BitField& field) { return static_cast<unsigned>(field.get(frame.data())); };
  const c::year_month_day date{c::year{w::kFirstYear + static_cast<int>(part(w::kYear))}, c::month{part(w::kMonth)},
                               c::day{part(w::kDay)}};
  const bool is_time = part(w::kHour) < 24 && part(w::kMinute) < 60 && part(w::kSecond) < 60;
  if (!date.ok() || !is_time || part(w::kMillisecond) >= 1000) return std::nullopt;
  const c::nanoseconds since_1970 = c::sys_days{date}.time_since_epoch() + c::hours{part(w::kHour)} +
                                    c::minutes{part(w::kMinute)} + c::seconds{part(w::kSecond)} +
                                    c::milliseconds{part(w::kMillisecond)};
  return since_1970.count();
}

}  // namespace

bool WitMotionParser::next(ImuSample& sample) {
  for (;;) {
    const Bytes bytes = buffer_.view();
    const auto sync = std::ranges::find(bytes, kWitMotionSync);
    skip(static_cast<std::size_t>(sync - bytes.begin()));
    if (buffer_.size() < kWitMotionFrameBytes) return false;
    if (!frame_is_sound()) {
      skip(1);
      continue;
    }
    const bool is_sample = take_frame(sample);
    ++counts_.frames;
    counts_.bytes_accepted += kWitMotionFrameBytes;
    buffer_.drop(kWitMotionFrameBytes);
    if (is_sample) return true;
  }
}

bool WitMotionParser::frame_is_sound() {
  const Bytes frame = buffer_.view();
  if (frame[1] < kWitMotionFirstId || frame[1] > kWitMotionLastId) {
    ++counts_.unknown_id;
    return false;
  }
  if (frame[kWitMotionChecksumAt] == witmotion_checksum(frame)) return true;
  ++counts_.bad_checksum;
  return false;
}

// What was skipped may have been a frame of the burst: halves of two samples must not meet.
void WitMotionParser::skip(std::size_t bytes) {
  if (bytes == 0) return;
  drop_burst();
  counts_.bytes_skipped += bytes;
  buffer_.drop(bytes);
}

void WitMotionParser::drop_burst() {
  if (burst_ && burst_->accel_mps2) ++counts_.orphan_acceleration;
  burst_.reset();
}

bool WitMotionParser::take_frame(ImuSample& sample) {
  const Bytes frame = buffer_.view().first(kWitMotionFrameBytes);
  switch (frame[1]) {
    case kWitMotionTime:
      take_time(frame);
      return false;
    case kWitMotionAcceleration:
      take_acceleration(frame);
      return false;
    case kWitMotionRate:
      return take_rate(frame, sample);
    default:
      ++counts_.no_imu_fields;
      drop_burst();
      return false;
  }
}

void WitMotionParser::take_time(Bytes frame) {
  drop_burst();
  burst_ = Burst{buffer_.sent(0), time_of(frame), {}};
  if (!burst_->sensor_ns) ++counts_.bad_time;
}

void WitMotionParser::take_acceleration(Bytes frame) {
  if (burst_ && burst_->accel_mps2) drop_burst();
  if (!burst_) burst_ = Burst{buffer_.sent(0), {}, {}};
  burst_->accel_mps2 = axes_of(frame, kWitMotionAccelUnit_mps2);
}

bool WitMotionParser::take_rate(Bytes frame, ImuSample& sample) {
  const bool whole = burst_ && burst_->accel_mps2;
  if (whole) {
    sample = {burst_->sensor_ns, buffer_.received(), burst_->sent, axes_of(frame, kWitMotionRateUnit_radps),
              *burst_->accel_mps2};
  } else {
    ++counts_.orphan_rate;
  }
  burst_.reset();
  return whole;
}

}  // namespace lxd
