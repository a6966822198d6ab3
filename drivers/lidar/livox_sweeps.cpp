// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/livox_sweeps.hpp"

namespace lxd {
namespace {

constexpr std::size_t kSweepPointsMax = 65'536;  // twice what 200,000 points a second fill

}  // namespace

LivoxSweeps::LivoxSweeps(const LivoxParser& parser, std::unique_ptr<SweepClock> clock, Duration period)
    : parser_(parser), builder_(period), clock_(std::move(clock)), storage_(kSweepPointsMax) {
  building_.storage = storage_;
}

bool LivoxSweeps::parse(std::span<const std::uint8_t> datagram) {
  return parser_.parse(datagram, packet_) && !packet_.is_imu();
}

// The packet that ends a sweep is the first of the next one.
bool LivoxSweeps::take(RigTime received, Sweep& sweep) {
  if (packet_.count > 0)
    clock_->observe(static_cast<std::int64_t>(packet_.timestamp_ns + packet_.duration_ns), received);
  bool whole = false;
  if (builder_.completes(packet_)) {
    whole = builder_.close(building_) && deliver(sweep);
    building_.count = 0;
  }
  builder_.add(packet_, building_);
  return whole;
}

std::span<const ImuSample> LivoxSweeps::inertial(std::span<const std::uint8_t> datagram, RigTime received) {
  LivoxPacket packet;
  if (!parser_.parse(datagram, packet) || !packet.is_imu()) return {};
  const LivoxImuSample read = packet.imu();
  const auto sensor_ns = static_cast<std::int64_t>(read.timestamp_ns);
  const auto t = clock_->rig_time(RigTime::from_ns(sensor_ns));
  if (!t) return {};
  sample_ = {sensor_ns, received, *t, read.gyro_radps, read.accel_mps2};
  return {&sample_, 1};
}

bool LivoxSweeps::deliver(Sweep& sweep) {
  sweep.begin = building_.begin;
  sweep.end = building_.end;
  sweep.stamp = building_.stamp;
  if (!clock_->place(sweep, rejected_)) return false;
  for (const LidarPoint& point : building_.points()) {
    if (!sweep.push(point)) ++no_room_;
  }
  sweep.lidar = 0;
  sweep.sequence = sequence_++;
  return true;
}

void LivoxSweeps::report_inertial(Rejections& rejected) const {
  set_rejected(rejected, {{"not_finite", parser_.counts().bad_imu_values}});
}

// The parts count for themselves, in numbers that only grow; here they get their names.
void LivoxSweeps::report(Rejections& rejected) const {
  for (const auto& [cause, times] : rejected_) rejected[cause] = times;
  const LivoxParserCounts& parser = parser_.counts();
  const LivoxSweepCounts& sweep = builder_.counts();
  set_rejected(rejected, {{"bad_size", parser.bad_size},
                          {"bad_type", parser.bad_type},
                          {"bad_time_type", parser.bad_time_type},
                          {"bad_count", parser.bad_count},
                          {"bad_crc", parser.bad_crc},
                          {"bad_time", parser.bad_time},
                          {"bad_imu_values", parser.bad_imu_values},
                          {"no_return", sweep.no_return},
                          {"noise_tag", sweep.noise_tag},
                          {"above_capacity", sweep.above_capacity + no_room_},
                          {"repeated_packet", sweep.repeated_packets},
                          {"stale_packet", sweep.late_packets},
                          {"missing_packet", sweep.missing_packets}});
}

}  // namespace lxd
