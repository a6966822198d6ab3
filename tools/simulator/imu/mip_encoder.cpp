// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/mip_encoder.hpp"

#include "drivers/imu/big_endian.hpp"
#include "drivers/imu/standard_gravity.hpp"

namespace lxd::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Room for a field, with its header.
std::uint8_t* append_field(Bytes& fields, const MipField& field) {
  const std::size_t bytes = kMipFieldHeaderBytes + field.data_bytes;
  fields.resize(fields.size() + bytes);
  std::uint8_t* const at = fields.data() + fields.size() - bytes;
  at[0] = static_cast<std::uint8_t>(bytes);
  at[1] = field.descriptor;
  return at + kMipFieldHeaderBytes;
}

}  // namespace

Bytes encode_mip_packet(std::uint8_t set, std::span<const std::uint8_t> payload) {
  Bytes packet{kMipSync[0], kMipSync[1], set, static_cast<std::uint8_t>(payload.size())};
  for (const std::uint8_t byte : payload) packet.push_back(byte);
  for (const std::uint8_t byte : mip_checksum(packet)) packet.push_back(byte);
  return packet;
}

Bytes mip_inertial_fields(const Inertial& sample) {
  Bytes fields;
  put_big_endian_floats(append_field(fields, mip::kScaledAccel), sample.accel_mps2 / kStandardGravity_mps2);
  put_big_endian_floats(append_field(fields, mip::kScaledGyro), sample.gyro_radps);
  return fields;
}

Bytes mip_reference_time(std::int64_t sensor_ns) {
  Bytes fields;
  put_big_endian(append_field(fields, mip::kReferenceTime), mip::kReferenceTime.data_bytes,
                 static_cast<std::uint64_t>(sensor_ns));
  return fields;
}

Bytes encode_mip(std::int64_t sensor_ns, const Inertial& sample) {
  Bytes fields = mip_inertial_fields(sample);
  for (const std::uint8_t byte : mip_reference_time(sensor_ns)) fields.push_back(byte);
  return encode_mip_packet(kMipImuSet, fields);
}

}  // namespace lxd::sim
