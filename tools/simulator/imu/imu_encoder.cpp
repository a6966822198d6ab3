// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/imu_encoder.hpp"

#include "tools/simulator/imu/mip_encoder.hpp"
#include "tools/simulator/imu/vectornav_ascii_encoder.hpp"
#include "tools/simulator/imu/vectornav_encoder.hpp"
#include "tools/simulator/imu/witmotion_encoder.hpp"
#include "tools/simulator/imu/xsens_encoder.hpp"

namespace lxd::sim {

std::size_t bytes_per_sample(ImuProtocol protocol) {
  switch (protocol) {
    case ImuProtocol::kVectorNavAscii:
      return kVectorNavLineBytes;
    case ImuProtocol::kWitMotion:
      return kWitMotionBurstBytes;
    case ImuProtocol::kMicroStrain:
      return kMipSampleBytes;
    case ImuProtocol::kXsens:
      return kXsensSampleBytes;
    case ImuProtocol::kVectorNav:
      break;
  }
  return vectornav_layout().frame_bytes();
}

bool can_be_sent(ImuProtocol protocol, std::int64_t sensor_ns) {
  if (protocol == ImuProtocol::kWitMotion) return is_witmotion_time(sensor_ns);
  if (protocol == ImuProtocol::kXsens) return sensor_ns >= 0 && sensor_ns < kXsensTimeEnd_ns;
  return protocol == ImuProtocol::kVectorNavAscii || sensor_ns >= 0;
}

std::string_view times_that_can_be_sent(ImuProtocol protocol) {
  if (protocol == ImuProtocol::kWitMotion) return "the years 2000 to 2255";
  return protocol == ImuProtocol::kXsens ? "0 to 429496 s, as its clock counts from power-up" : "0 or later";
}

std::vector<std::uint8_t> encode_sample(ImuProtocol protocol, std::uint64_t number, std::int64_t sensor_ns,
                                        const Inertial& sample) {
  switch (protocol) {
    case ImuProtocol::kVectorNavAscii:
      return encode_vectornav_line(sample);
    case ImuProtocol::kWitMotion:
      return encode_witmotion(sensor_ns, sample);
    case ImuProtocol::kMicroStrain:
      return encode_mip(sensor_ns, sample);
    case ImuProtocol::kXsens:
      return encode_xsens(number, sensor_ns, sample);
    case ImuProtocol::kVectorNav:
      break;
  }
  return encode_vectornav(vectornav_layout(), sensor_ns, sample);
}

}  // namespace lxd::sim
