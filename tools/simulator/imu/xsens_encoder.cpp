// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/xsens_encoder.hpp"

#include "drivers/imu/big_endian.hpp"

namespace lxd::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Room for an item's value, behind its id and size.
std::uint8_t* append_item(Bytes& data, unsigned id, std::size_t bytes) {
  data.resize(data.size() + kXsensItemHeaderBytes + bytes);
  std::uint8_t* const at = data.data() + data.size() - bytes;
  put_big_endian(at - kXsensItemHeaderBytes, 2, id);
  at[-1] = static_cast<std::uint8_t>(bytes);
  return at;
}

}  // namespace

Bytes encode_xsens_message(std::uint8_t message, std::span<const std::uint8_t> data) {
  Bytes frame{kXsensSync, kXsensBus, message};
  if (data.size() < kXsensExtendedLength) {
    frame.push_back(static_cast<std::uint8_t>(data.size()));
  } else {
    frame.push_back(kXsensExtendedLength);
    frame.push_back(static_cast<std::uint8_t>(data.size() >> 8U));
    frame.push_back(static_cast<std::uint8_t>(data.size()));
  }
  for (const std::uint8_t byte : data) frame.push_back(byte);
  frame.push_back(static_cast<std::uint8_t>(-xsens_sum(std::span(frame).subspan(1))));
  return frame;
}

Bytes encode_xsens(std::uint64_t counter, std::int64_t sensor_ns, const Inertial& sample) {
  constexpr std::size_t kVectorBytes = 3 * sizeof(float);
  Bytes data;
  put_big_endian(append_item(data, xsens::kPacketCounter, 2), 2, counter);
  put_big_endian(append_item(data, xsens::kSampleTime, 4), 4,
                 static_cast<std::uint64_t>(sensor_ns / xsens::kSampleTick_ns));
  put_big_endian_floats(append_item(data, xsens::kAccel, kVectorBytes), sample.accel_mps2);
  put_big_endian_floats(append_item(data, xsens::kRate, kVectorBytes), sample.gyro_radps);
  return encode_xsens_message(kXsensData, data);
}

}  // namespace lxd::sim
