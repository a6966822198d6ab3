// SPDX-License-Identifier: Apache-2.0
// Any frames through the wheel decoder: the first byte picks vehicle and kinematics, then 13 bytes make a frame.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "drivers/wheel/wheel_decoder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lxd;
  constexpr std::size_t kFrameBytes = 13;
  if (size == 0) return 0;
  const Vehicle& vehicle = kVehicles[data[0] % kVehicles.size()];
  WheelDecoderConfig config{vehicle.messages(), static_cast<WheelSource>(data[0] / 8 % kWheelKinematicsNames.size()),
                            1};
  config.wheelbase_m = 2;
  WheelDecoder decoder(config);
  RigTime received;
  for (const std::uint8_t* at = data + 1; at + kFrameBytes <= data + size; at += kFrameBytes) {
    CanFrame frame;
    frame.received = received = received + Duration::from_ns(1'000'000 * std::int64_t{at[0]});
    frame.id = static_cast<std::uint32_t>(at[1] << 8U | at[2]);
    frame.extended = (at[3] & 1U) != 0;
    frame.kind = static_cast<CanKind>(at[3] / 2 % 3);
    frame.length = std::min<std::uint8_t>(at[4], kCanMaxData);
    std::copy_n(at + 5, kCanMaxData, frame.data.begin());
    const auto sample = decoder.decode(frame);
    if (!sample) continue;
    if (!(std::abs(sample->speed_mps) <= config.speed_max_mps)) std::abort();
    if (!(std::abs(sample->yaw_rate_radps) <= config.yaw_rate_max_radps)) std::abort();
  }
  return 0;
}
