// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/livox_encoder.hpp"

#include <bit>
#include <cmath>

#include "drivers/crc.hpp"

namespace lxd::sim {
namespace {

void put_signed(const BitField& field, std::uint8_t* block, double units) {
  field.set(block, static_cast<std::uint64_t>(std::llround(units)));
}

std::vector<std::uint8_t> framed(const LivoxHeader& header, std::uint64_t data_type, std::size_t count,
                                 std::size_t data_bytes) {
  std::vector<std::uint8_t> packet(kLivoxHeaderBytes + data_bytes);
  std::uint8_t* const at = packet.data();
  kLivoxHeader.length.set(at, packet.size());
  kLivoxHeader.time_interval.set(at, header.duration_ns / static_cast<std::uint64_t>(kLivoxIntervalUnit_ns));
  kLivoxHeader.record_count.set(at, count);
  kLivoxHeader.packet_counter.set(at, header.packet_counter);
  kLivoxHeader.frame_counter.set(at, header.frame_counter);
  kLivoxHeader.data_type.set(at, data_type);
  kLivoxHeader.time_type.set(at, static_cast<std::uint64_t>(header.clock));
  kLivoxHeader.timestamp_ns.set(at, header.timestamp_ns);
  return packet;
}

void check(std::vector<std::uint8_t>& packet) {
  kLivoxHeader.crc.set(packet.data(), crc32(std::span(packet).subspan(kLivoxCheckedFrom)));
}

}  // namespace

std::vector<std::uint8_t> encode_livox_points(const LivoxRecord& record, const LivoxHeader& header,
                                              std::span<const LivoxReturn> shots) {
  auto packet = framed(header, record.data_type, shots.size(), shots.size() * record.bytes);
  std::uint8_t* block = packet.data() + kLivoxHeaderBytes;
  for (const LivoxReturn& shot : shots) {
    put_signed(record.x, block, shot.p_m.x() / record.unit_m);
    put_signed(record.y, block, shot.p_m.y() / record.unit_m);
    put_signed(record.z, block, shot.p_m.z() / record.unit_m);
    record.reflectivity.set(block, shot.reflectivity);
    record.tag.set(block, shot.tag);
    block += record.bytes;
  }
  check(packet);
  return packet;
}

std::vector<std::uint8_t> encode_livox_imu(const LivoxHeader& header, const Eigen::Vector3d& gyro_radps,
                                           const Eigen::Vector3d& accel_mps2) {
  auto packet = framed(header, kLivoxImuType, 1, kLivoxImuBytes);
  const Eigen::Vector3d accel_g = accel_mps2 / kLivoxGravity_mps2;
  for (int axis = 0; axis < 3; ++axis) {
    std::uint8_t* const data = packet.data() + kLivoxHeaderBytes;
    bytes_at(4 * axis, 4).set(data, std::bit_cast<std::uint32_t>(static_cast<float>(gyro_radps[axis])));
    bytes_at(4 * (axis + 3), 4).set(data, std::bit_cast<std::uint32_t>(static_cast<float>(accel_g[axis])));
  }
  check(packet);
  return packet;
}

}  // namespace lxd::sim
