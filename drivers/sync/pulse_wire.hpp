// SPDX-License-Identifier: Apache-2.0
// A pulse as a chunk: one byte of a GPIO line's edge (GpioEdge), or the four of the kernel's count of a pulse source,
// lowest first; `received` is the edge's stamp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/device/device.hpp"
#include "drivers/sync/gpio_edges.hpp"
#include "drivers/sync/pps_source.hpp"

namespace lxd {

inline constexpr std::size_t kPulseBytes = 4;

class PulseReader {
 public:
  // begins: the edge of a GPIO line at which the second begins.
  explicit PulseReader(GpioEdge begins) : begins_(begins) {}

  // The pulse of a chunk, its count going on over a source that counts anew; none: the other edge of its line.
  std::optional<PpsPulse> read(const Chunk& chunk);

 private:
  GpioEdge begins_;
  std::uint32_t last_ = 0;   // of the source's count
  std::uint32_t count_ = 0;  // given
};

// Whether the chunk is that edge of a GPIO line.
bool is_edge(const Chunk& chunk, GpioEdge edge);

}  // namespace lxd
