// SPDX-License-Identifier: Apache-2.0
// Any stamps as a sensor's clock: receive times grow, sensor times are whatever the wire says. What is given grows with
// its argument, and what the model learned never overflows.
#include <cstdlib>
#include <cstring>

#include "drivers/sync/clock_model.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lxd;
  constexpr std::size_t kPairBytes = 12;
  ClockModel model{{}};
  RigTime received = RigTime::from_ns(1'750'000'000'000'000'000);
  for (std::size_t at = 0; at + kPairBytes <= size; at += kPairBytes) {
    std::int64_t sensor_ns = 0;
    std::uint32_t since_us = 0;
    std::memcpy(&sensor_ns, data + at, sizeof sensor_ns);
    std::memcpy(&since_us, data + at + sizeof sensor_ns, sizeof since_us);
    received = received + Duration::from_ns(std::int64_t{since_us} * 1000);
    if ((since_us & 1U) != 0) {
      model.add_edge(received);
      continue;
    }
    if (model.add(sensor_ns, received) == ClockVerdict::refused) continue;
    if (model.to_rig(sensor_ns + 1'000'000) < model.to_rig(sensor_ns)) std::abort();
    if (model.bound(received) < Duration()) std::abort();
  }
  return 0;
}
