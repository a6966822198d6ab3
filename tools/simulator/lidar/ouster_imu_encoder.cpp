// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/ouster_imu_encoder.hpp"

#include <bit>

#include "drivers/crc.hpp"

namespace lxd::sim {
namespace {

void put_floats(std::uint8_t* record, int offset, const Eigen::Vector3d& value) {
  for (int axis = 0; axis < 3; ++axis) {
    bytes_at(offset + 4 * axis, 4).set(record, std::bit_cast<std::uint32_t>(static_cast<float>(value[axis])));
  }
}

}  // namespace

std::vector<std::uint8_t> encode_ouster_imu(const OusterImuProfile& profile, const OusterImuHeader& header,
                                            std::span<const OusterImuSample> samples) {
  const OusterImuRecord& record = profile.record;
  std::vector<std::uint8_t> packet(profile.header_bytes + samples.size() * record.bytes + profile.footer_bytes);
  std::uint8_t* at = packet.data() + profile.header_bytes;
  std::uint64_t measurement_id = header.first_measurement_id;
  for (const OusterImuSample& sample : samples) {
    record.gyro_ns.set(at, sample.gyro_ns);
    record.accel_ns.set(at, sample.accel_ns);
    record.measurement_id.set(at, measurement_id);
    measurement_id += header.measurement_step;
    record.status.set(at, 1);
    put_floats(at, record.accel_at, sample.accel_mps2 / record.accel_unit_mps2);
    put_floats(at, record.gyro_at, sample.gyro_radps / record.gyro_unit_radps);
    at += record.bytes;
  }
  profile.packet_type.set(packet.data(), kOusterImuPacket);
  profile.frame_id.set(packet.data(), header.frame_id);
  profile.init_id.set(packet.data(), header.init_id);
  profile.serial.set(packet.data(), header.serial);
  profile.system_ns.set(packet.data(), header.system_ns);
  profile.crc.set(packet.data() + packet.size() - profile.footer_bytes,
                  crc64(std::span(packet).first(packet.size() - (profile.crc.present() ? sizeof(std::uint64_t) : 0))));
  return packet;
}

}  // namespace lxd::sim
