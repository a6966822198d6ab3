// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/serial_line.hpp"

#include <algorithm>

namespace lxd::sim {
namespace {

constexpr double kLineBitsPerByte = 10;  // a start and a stop bit around eight

}  // namespace

SerialLine::SerialLine(const SerialLineConfig& config, const SensorClock& clock, RigTime start, Random random,
                       SerialLogWriter& log)
    : clock_(clock),
      random_(random),
      log_(log),
      byte_time_(Duration::from_seconds(kLineBitsPerByte / config.baud_rate)),
      timer_(Duration::from_seconds(config.chunk_timer_s)),
      capacity_(static_cast<std::size_t>(config.chunk_bytes)),
      free_(start),
      tick_(start + Duration::from_seconds(config.chunk_timer_s * random_.uniform())),
      last_read_(start) {}

Status SerialLine::send(RigTime ready, std::span<const std::uint8_t> bytes) {
  free_ = std::max(free_, ready);
  for (const std::uint8_t byte : bytes) {
    free_ = free_ + byte_time_;
    if (Status taken = take(free_, byte); !taken) return taken;
  }
  return success();
}

Status SerialLine::finish() { return hand_over(tick_); }

Status SerialLine::take(RigTime arrived, std::uint8_t byte) {
  if (tick_ < arrived) {
    if (Status done = hand_over(tick_); !done) return done;
    tick_ = tick_ + timer_ * (1 + (arrived - tick_).ns() / timer_.ns());
  }
  held_.push_back(byte);
  if (held_.size() == capacity_) return hand_over(arrived);
  return success();
}

Status SerialLine::hand_over(RigTime at) {
  if (held_.empty()) return success();
  last_read_ = std::max(last_read_, clock_.received(at, random_));
  Status written = log_.append(last_read_, held_);
  held_.clear();
  return written;
}

}  // namespace lxd::sim
