// SPDX-License-Identifier: Apache-2.0
// See imu_parser.hpp.
#include "drivers/ouster/imu_parser.hpp"

#include <bit>

#include "drivers/crc.hpp"
#include "drivers/refuse.hpp"

namespace lxd {
namespace {

constexpr std::uint64_t kValid = 1;

Eigen::Vector3d floats_at(const std::uint8_t* record, int offset) {
  Eigen::Vector3d v;
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = std::bit_cast<float>(static_cast<std::uint32_t>(bytes_at(offset + 4 * axis, 4).get(record)));
  }
  return v;
}

}  // namespace

bool OusterImuParser::parse(std::span<const std::uint8_t> datagram, OusterImuPacket& packet) {
  const std::size_t records = records_in(datagram.size());
  if (records == 0) return refuse(counts_.bad_size);
  if (!accept_header(datagram)) return false;
  packet.count = 0;
  for (std::size_t i = 0; i < records; ++i) {
    take_record(datagram.data() + profile_.header_bytes + i * profile_.record.bytes, packet);
  }
  ++counts_.packets;
  return true;
}

// 0: no size that a packet of this profile has.
std::size_t OusterImuParser::records_in(std::size_t datagram_bytes) const {
  const std::size_t around = profile_.header_bytes + profile_.footer_bytes;
  if (datagram_bytes < around + profile_.record.bytes) return 0;
  const std::size_t records = (datagram_bytes - around) / profile_.record.bytes;
  const bool whole = records * profile_.record.bytes == datagram_bytes - around;
  const bool expected = profile_.fixed_records == 0 || records == profile_.fixed_records;
  return whole && expected && records <= kOusterImuMaxRecords ? records : 0;
}

bool OusterImuParser::accept_header(std::span<const std::uint8_t> datagram) {
  const std::uint8_t* const header = datagram.data();
  if (profile_.packet_type.present() && profile_.packet_type.get(header) != kOusterImuPacket) {
    return refuse(counts_.bad_packet_type);
  }
  if (!crc_holds(datagram)) return refuse(counts_.bad_crc);
  if (init_id_ && profile_.init_id.present() && profile_.init_id.get(header) != *init_id_) {
    return refuse(counts_.bad_init_id);
  }
  return true;
}

// Firmware that sends this profile always fills the check value.
bool OusterImuParser::crc_holds(std::span<const std::uint8_t> datagram) const {
  if (!profile_.crc.present()) return true;
  const std::uint8_t* const footer = datagram.data() + datagram.size() - profile_.footer_bytes;
  return profile_.crc.get(footer) == crc64(datagram.first(datagram.size() - sizeof(std::uint64_t)));
}

void OusterImuParser::take_record(const std::uint8_t* bytes, OusterImuPacket& packet) {
  const OusterImuRecord& record = profile_.record;
  if (record.status.present() && (record.status.get(bytes) & kValid) == 0) {
    ++counts_.invalid_record;
    return;
  }
  const OusterImuSample sample{record.accel_ns.get(bytes), record.gyro_ns.get(bytes),
                               floats_at(bytes, record.accel_at) * record.accel_unit_mps2,
                               floats_at(bytes, record.gyro_at) * record.gyro_unit_radps};
  if (!sample.accel_mps2.allFinite() || !sample.gyro_radps.allFinite()) {
    ++counts_.non_finite_record;
    return;
  }
  packet.storage[packet.count++] = sample;
}

}  // namespace lxd
