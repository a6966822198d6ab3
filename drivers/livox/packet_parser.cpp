// SPDX-License-Identifier: Apache-2.0
// See packet_parser.hpp.
#include "drivers/livox/packet_parser.hpp"

#include <bit>
#include <cmath>
#include <numbers>

#include "drivers/crc.hpp"
#include "drivers/refuse.hpp"

namespace lxd {
namespace {

bool crc_holds(std::span<const std::uint8_t> datagram) {
  const std::uint64_t found = kLivoxHeader.crc.get(datagram.data());
  return found == 0 || found == crc32(datagram.subspan(kLivoxCheckedFrom));
}

// Two's complement of the field's width.
double signed_value(const BitField& field, const std::uint8_t* block) {
  const auto unused = static_cast<unsigned>(64 - field.bits);
  return static_cast<double>(static_cast<std::int64_t>(field.get(block) << unused) >> unused);
}

// `shot` has the angles, `echo` all else.
Eigen::Vector3f position_m(const LivoxRecord& record, const std::uint8_t* shot, const std::uint8_t* echo) {
  if (!record.depth.present()) {
    const Eigen::Vector3d units(signed_value(record.x, echo), signed_value(record.y, echo),
                                signed_value(record.z, echo));
    return (units * record.unit_m).cast<float>();
  }
  constexpr double kUnit_rad = kLivoxAngleUnit_deg * std::numbers::pi / 180;
  const double depth_m = static_cast<double>(record.depth.get(echo)) * record.unit_m;
  const double zenith = static_cast<double>(record.zenith.get(shot)) * kUnit_rad;
  const double azimuth = static_cast<double>(record.azimuth.get(shot)) * kUnit_rad;
  const Eigen::Vector3d direction(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth),
                                  std::cos(zenith));
  return (depth_m * direction).cast<float>();
}

double float_at(const std::uint8_t* data, int index) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bytes_at(4 * index, 4).get(data)));
}

}  // namespace

bool livox_imu_is_finite(const std::uint8_t* record) {
  for (int i = 0; i < 6; ++i) {
    if (!std::isfinite(float_at(record, i))) return false;
  }
  return true;
}

LivoxPoint LivoxPacket::point(std::uint32_t i, std::uint32_t echo) const {
  const std::uint8_t* const shot = data + i * record->bytes;
  const std::uint8_t* const block = shot + echo * record->echo_bytes;
  const auto tag = static_cast<std::uint8_t>(record->tag.get(block));
  return {position_m(*record, shot, block),
          static_cast<std::uint8_t>(record->reflectivity.get(block)),
          tag,
          livox_tag_is_noise(tag, record->tags),
          static_cast<std::uint8_t>(i % lines),
          static_cast<std::uint32_t>(std::uint64_t{duration_ns} * i / count)};
}

LivoxImuSample LivoxPacket::imu() const {
  const Eigen::Vector3d gyro(float_at(data, 0), float_at(data, 1), float_at(data, 2));
  const Eigen::Vector3d accel_g(float_at(data, 3), float_at(data, 4), float_at(data, 5));
  return {timestamp_ns, gyro, accel_g * kLivoxGravity_mps2};
}

bool LivoxPacketParser::parse(std::span<const std::uint8_t> datagram, LivoxPacket& packet) {
  if (!accept(datagram)) return false;
  const std::uint8_t* const header = datagram.data();
  packet.timestamp_ns = kLivoxHeader.timestamp_ns.get(header);
  packet.duration_ns =
      static_cast<std::uint32_t>(kLivoxHeader.time_interval.get(header) * std::uint64_t{kLivoxIntervalUnit_ns});
  packet.packet_counter = static_cast<std::uint16_t>(kLivoxHeader.packet_counter.get(header));
  packet.frame_counter = static_cast<std::uint8_t>(kLivoxHeader.frame_counter.get(header));
  packet.clock = static_cast<LivoxClock>(kLivoxHeader.time_type.get(header));
  packet.record = find_livox_record(kLivoxHeader.data_type.get(header));
  packet.count = packet.is_imu() ? 0 : static_cast<std::uint32_t>(kLivoxHeader.record_count.get(header));
  packet.lines = lines_;
  packet.data = header + kLivoxHeaderBytes;
  ++(packet.is_imu() ? counts_.imu_packets : counts_.packets);
  return true;
}

bool LivoxPacketParser::accept(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kLivoxHeaderBytes) return refuse(counts_.bad_size);
  const std::uint8_t* const header = datagram.data();
  if (kLivoxHeader.length.get(header) != datagram.size()) return refuse(counts_.bad_size);
  if (!accept_records(datagram)) return false;
  if (kLivoxHeader.time_type.get(header) >= kLivoxClocks) return refuse(counts_.bad_time_type);
  if (!crc_holds(datagram)) return refuse(counts_.bad_crc);
  if (kLivoxHeader.timestamp_ns.get(header) >= kLivoxLatestTime_ns) return refuse(counts_.bad_time);
  return true;
}

bool LivoxPacketParser::accept_records(std::span<const std::uint8_t> datagram) {
  const std::uint64_t type = kLivoxHeader.data_type.get(datagram.data());
  const auto count = static_cast<std::size_t>(kLivoxHeader.record_count.get(datagram.data()));
  const std::size_t data_bytes = datagram.size() - kLivoxHeaderBytes;
  if (type == kLivoxImuType) {
    if (count != 1 || data_bytes != kLivoxImuBytes) return refuse(counts_.bad_count);
    return livox_imu_is_finite(datagram.data() + kLivoxHeaderBytes) || refuse(counts_.bad_imu_values);
  }
  const LivoxRecord* const record = find_livox_record(type);
  if (record == nullptr) return refuse(counts_.bad_type);
  if (count == 0 || count * record->bytes != data_bytes) return refuse(counts_.bad_count);
  return true;
}

}  // namespace lxd
