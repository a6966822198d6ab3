// SPDX-License-Identifier: Apache-2.0
// See sdk1_parser.hpp.
#include "drivers/livox/sdk1_parser.hpp"

#include <chrono>

#include "drivers/refuse.hpp"

namespace lxd {
namespace {

constexpr std::uint64_t kHour_us = 3'600'000'000;

bool is_time_type(std::uint64_t type) {
  return type == kLivoxSdk1Uptime || type == kLivoxSdk1Ptp || type == kLivoxSdk1Gps || type == kLivoxSdk1Pps;
}

std::optional<std::uint64_t> utc_ns(const std::uint8_t* stamp) {
  namespace c = std::chrono;
  const auto part = [&](const BitField& field) { return static_cast<unsigned>(field.get(stamp)); };
  const c::year_month_day date{c::year{kLivoxSdk1FirstYear + static_cast<int>(part(kLivoxSdk1Utc.year))},
                               c::month{part(kLivoxSdk1Utc.month)}, c::day{part(kLivoxSdk1Utc.day)}};
  if (!date.ok() || part(kLivoxSdk1Utc.hour) >= 24 || part(kLivoxSdk1Utc.microseconds) >= kHour_us) return std::nullopt;
  const c::nanoseconds since_1970 = c::sys_days{date}.time_since_epoch() + c::hours{part(kLivoxSdk1Utc.hour)} +
                                    c::microseconds{part(kLivoxSdk1Utc.microseconds)};
  return static_cast<std::uint64_t>(since_1970.count());
}

// A pulse without a date leaves the count the sensor's own.
LivoxClock clock_of(std::uint64_t time_type) {
  if (time_type == kLivoxSdk1Gps) return LivoxClock::kGps;
  return time_type == kLivoxSdk1Ptp ? LivoxClock::kPtp : LivoxClock::kUptime;
}

}  // namespace

std::optional<std::uint64_t> livox_sdk1_time_ns(std::uint64_t time_type, const std::uint8_t* stamp) {
  const std::uint64_t ns = bytes_at(0, 8).get(stamp);
  if (time_type == kLivoxSdk1Gps) return utc_ns(stamp);
  return ns < kLivoxLatestTime_ns ? std::optional(ns) : std::nullopt;
}

bool LivoxSdk1Parser::parse(std::span<const std::uint8_t> datagram, LivoxPacket& packet) {
  if (!accept(datagram)) return false;
  const std::uint8_t* const header = datagram.data();
  const std::uint64_t time_type = kLivoxSdk1Header.time_type.get(header);
  packet = {};
  packet.record = find_livox_sdk1_record(kLivoxSdk1Header.data_type.get(header));
  packet.data = header + kLivoxSdk1HeaderBytes;
  packet.clock = clock_of(time_type);
  if (!packet.is_imu()) {
    packet.count = static_cast<std::uint32_t>((datagram.size() - kLivoxSdk1HeaderBytes) / packet.record->bytes);
    packet.duration_ns = packet.count * shot_ns_;
  }
  packet.timestamp_ns = *livox_sdk1_time_ns(time_type, header + kLivoxSdk1TimeAt);
  ++(packet.is_imu() ? counts_.imu_packets : counts_.packets);
  return true;
}

bool LivoxSdk1Parser::accept(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kLivoxSdk1HeaderBytes) return refuse(counts_.bad_size);
  const std::uint8_t* const header = datagram.data();
  const std::size_t data_bytes = datagram.size() - kLivoxSdk1HeaderBytes;
  const std::uint64_t type = kLivoxSdk1Header.data_type.get(header);
  if (type == kLivoxSdk1ImuType) {
    if (data_bytes != kLivoxImuBytes) return refuse(counts_.bad_count);
    if (!livox_imu_is_finite(header + kLivoxSdk1HeaderBytes)) return refuse(counts_.bad_imu_values);
  } else {
    const LivoxRecord* const record = find_livox_sdk1_record(type);
    if (record == nullptr) return refuse(counts_.bad_type);
    const std::size_t count = data_bytes / record->bytes;
    if (count == 0 || count > kLivoxSdk1ShotsMax || count * record->bytes != data_bytes)
      return refuse(counts_.bad_count);
  }
  const std::uint64_t time_type = kLivoxSdk1Header.time_type.get(header);
  if (!is_time_type(time_type)) return refuse(counts_.bad_time_type);
  return livox_sdk1_time_ns(time_type, header + kLivoxSdk1TimeAt).has_value() || refuse(counts_.bad_time);
}

}  // namespace lxd
