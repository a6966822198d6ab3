// SPDX-License-Identifier: Apache-2.0
// Any bytes as Livox SDK1 datagrams, through parser and sweep builder. Each datagram is preceded by its length, a byte,
// in units of eight bytes.
#include <cmath>
#include <cstdlib>
#include <vector>

#include "drivers/livox/sdk1_parser.hpp"
#include "drivers/livox/sweep_builder.hpp"

namespace {

using namespace lxd;

void end_sweep(LivoxSweepBuilder& builder, Sweep& sweep) {
  if (builder.close(sweep)) {
    for (const LidarPoint& p : sweep.points()) {
      if (sweep.begin + Duration::from_ns(p.offset_ns) > sweep.end || !std::isfinite(p.x_m + p.y_m + p.z_m))
        std::abort();
    }
  }
  sweep.count = 0;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  LivoxSdk1Parser parser(kLivoxHorizonShot_ns);
  LivoxSweepBuilder builder(Duration::from_ns(100'000'000));
  std::array<LidarPoint, 32> storage;  // fewer than packets bring, so that the overflow is met too
  Sweep sweep;
  sweep.storage = storage;
  LivoxPacket packet;
  std::span<const std::uint8_t> rest(data, size);
  while (!rest.empty()) {
    const std::size_t bytes = std::min<std::size_t>(rest.size() - 1, std::size_t{rest[0]} * 8);
    const std::vector<std::uint8_t> datagram(rest.begin() + 1, rest.begin() + 1 + static_cast<std::ptrdiff_t>(bytes));
    rest = rest.subspan(1 + bytes);
    if (!parser.parse(datagram, packet)) continue;
    if (packet.is_imu()) {
      if (!packet.imu().accel_mps2.allFinite()) std::abort();
      continue;
    }
    if (builder.completes(packet)) end_sweep(builder, sweep);
    builder.add(packet, sweep);
  }
  end_sweep(builder, sweep);
  return 0;
}
