// SPDX-License-Identifier: Apache-2.0
// See sweep_builder.hpp.
#include "drivers/livox/sweep_builder.hpp"

#include <algorithm>

namespace lxd {
namespace {

constexpr std::uint64_t kRestart_ns = 1'000'000'000;      // packets are never overtaken by this much
constexpr std::uint32_t kSteppedRun = 4;                  // late packets in a row: no network holds back so many
constexpr std::uint64_t kLongestGap_ns = 10'000'000'000;  // a longer one is a clock that was set, not loss
constexpr std::uint64_t kStep_ns = 50'000'000;            // a shorter gap is never taken for a clock's step

}  // namespace

bool LivoxSweepBuilder::restarted(const LivoxPacket& packet) const {
  if (packet.timestamp_ns + kRestart_ns < begin_ns_) return true;
  return packet.timestamp_ns < begin_ns_ && late_run_ + 1 >= kSteppedRun;
}

bool LivoxSweepBuilder::completes(const LivoxPacket& packet) const {
  return open_ && (packet.timestamp_ns >= begin_ns_ + period_ns_ || restarted(packet));
}

void LivoxSweepBuilder::add(const LivoxPacket& packet, Sweep& sweep) {
  if (restarted(packet)) forget();
  if (repeated(packet.timestamp_ns)) return;
  count_missing(packet);
  packet_counter_ = packet.packet_counter;
  frame_counter_ = packet.frame_counter;
  if (packet.timestamp_ns < begin_ns_) {
    ++late_run_;
    ++counts_.late_packets;
    return;
  }
  late_run_ = 0;
  if (!open_) {
    open_ = true;
    begin_ns_ = last_ns_ = packet.timestamp_ns;
  }
  add_points(packet, sweep);
}

bool LivoxSweepBuilder::close(Sweep& sweep) {
  open_ = false;
  sweep.begin = RigTime::from_ns(static_cast<std::int64_t>(begin_ns_));
  sweep.end = sweep.stamp = RigTime::from_ns(static_cast<std::int64_t>(last_ns_));
  begin_ns_ = last_ns_;  // what comes from before is late
  return sweep.count > 0;
}

// A sensor whose clock went back begins anew: nothing of its first packets is late or missing.
void LivoxSweepBuilder::forget() {
  begin_ns_ = 0;
  late_run_ = 0;
  next_ns_ = kNever;
  recent_ns_.fill(kNever);
}

bool LivoxSweepBuilder::repeated(std::uint64_t timestamp_ns) {
  if (std::find(recent_ns_.begin(), recent_ns_.end(), timestamp_ns) != recent_ns_.end()) {
    ++counts_.repeated_packets;
    return true;
  }
  recent_ns_[recent_] = timestamp_ns;
  recent_ = (recent_ + 1) % kRemembered;
  return false;
}

// By the sensor's own counters, which know nothing of its clock.
bool LivoxSweepBuilder::is_next(const LivoxPacket& packet) const {
  if (packet.frame_counter == frame_counter_)
    return packet.packet_counter == static_cast<std::uint16_t>(packet_counter_ + 1);
  return packet.frame_counter == static_cast<std::uint8_t>(frame_counter_ + 1) && packet.packet_counter == 0;
}

void LivoxSweepBuilder::count_missing(const LivoxPacket& packet) {
  const std::uint64_t begin = packet.timestamp_ns;
  const std::uint64_t duration = std::max<std::uint64_t>(packet.duration_ns, 1);
  if (next_ns_ != kNever && begin + duration <= next_ns_) {  // overtaken on its way: counted as missing before
    if (counts_.missing_packets > 0) --counts_.missing_packets;
    return;
  }
  const std::uint64_t gap_ns = next_ns_ != kNever && begin > next_ns_ ? begin - next_ns_ : 0;
  const bool stepped = gap_ns >= kStep_ns && (gap_ns >= kLongestGap_ns || is_next(packet));
  if (!stepped) counts_.missing_packets += (gap_ns + duration / 2) / duration;
  next_ns_ = begin + duration;
}

// Echoes of one shot follow each other, as the sensor sends them.
void LivoxSweepBuilder::add_points(const LivoxPacket& packet, Sweep& sweep) {
  const std::uint64_t first_ns = packet.timestamp_ns - begin_ns_;
  for (std::uint32_t i = 0; i < packet.count; ++i) {
    for (std::uint32_t echo = 0; echo < packet.echoes(); ++echo) add_point(packet.point(i, echo), first_ns, sweep);
  }
}

void LivoxSweepBuilder::add_point(const LivoxPoint& point, std::uint64_t packet_ns, Sweep& sweep) {
  if (point.p_m.isZero(0)) {
    ++counts_.no_return;
  } else if (point.noise) {
    ++counts_.noise_tag;
  } else {
    const auto offset_ns = static_cast<std::uint32_t>(packet_ns + point.offset_ns);
    const auto intensity = static_cast<float>(point.reflectivity);
    if (!sweep.push({point.p_m.x(), point.p_m.y(), point.p_m.z(), intensity, offset_ns})) ++counts_.above_capacity;
    last_ns_ = std::max(last_ns_, begin_ns_ + offset_ns);
  }
}

}  // namespace lxd
