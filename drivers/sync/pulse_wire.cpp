// SPDX-License-Identifier: Apache-2.0
#include "drivers/sync/pulse_wire.hpp"

namespace lxd {

bool is_edge(const Chunk& chunk, GpioEdge edge) {
  return chunk.bytes.size() == 1 && chunk.bytes[0] == static_cast<std::uint8_t>(edge);
}

std::optional<PpsPulse> PulseReader::read(const Chunk& chunk) {
  if (chunk.bytes.size() != kPulseBytes) {
    if (!is_edge(chunk, begins_)) return std::nullopt;
    return PpsPulse{chunk.received, ++count_};
  }
  constexpr unsigned kByteBits = 8;
  std::uint32_t sequence = 0;
  for (unsigned i = 0; i < kPulseBytes; ++i) sequence |= std::uint32_t{chunk.bytes[i]} << kByteBits * i;
  const bool goes_on = count_ > 0 && sequence > last_;
  count_ += goes_on ? sequence - last_ : 1;
  last_ = sequence;
  return PpsPulse{chunk.received, count_};
}

}  // namespace lxd
