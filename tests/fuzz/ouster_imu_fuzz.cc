// SPDX-License-Identifier: Apache-2.0
// Any bytes as an Ouster's inertial datagram. The first byte picks the profile.
#include <cstdlib>
#include <vector>

#include "drivers/ouster/imu_parser.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lxd;
  if (size == 0) return 0;
  OusterImuParser parser(data[0] % 2 == 0 ? kOusterLegacyImu : kOusterAccelGyroNmea, std::nullopt);
  const std::vector<std::uint8_t> datagram(data + 1, data + size);
  OusterImuPacket packet;
  if (!parser.parse(datagram, packet)) return 0;
  if (packet.samples().size() * 36 > datagram.size()) std::abort();
  for (const OusterImuSample& sample : packet.samples()) {
    if (!sample.accel_mps2.allFinite() || !sample.gyro_radps.allFinite()) std::abort();
  }
  return 0;
}
