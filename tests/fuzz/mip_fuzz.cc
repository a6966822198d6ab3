// SPDX-License-Identifier: Apache-2.0
// Any bytes through the MicroStrain parser, in pieces of the size that the first byte says.
#include <algorithm>
#include <cstdlib>

#include "drivers/imu/mip_parser.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lxd;
  if (size == 0) return 0;
  const std::size_t piece = std::size_t{1} + data[0];
  std::span<const std::uint8_t> rest(data + 1, size - 1);
  MipParser parser(115200);
  ImuSample sample;
  const RigTime received = RigTime::from_seconds(1);
  while (!rest.empty()) {
    const std::size_t taken = parser.feed(rest.first(std::min(piece, rest.size())), received);
    if (taken == 0) std::abort();
    while (parser.next(sample)) {
      if (!sample.gyro_radps.allFinite() || !sample.accel_mps2.allFinite() || sample.t > received) std::abort();
    }
    rest = rest.subspan(taken);
  }
  const MipCounts& counts = parser.counts();
  if (counts.bytes_accepted + counts.bytes_skipped + parser.bytes_pending() != size - 1) std::abort();
  if (parser.bytes_pending() >= kMipMaxPacketBytes) std::abort();
  return 0;
}
