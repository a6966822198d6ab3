// SPDX-License-Identifier: Apache-2.0
// What beams say of layers. What moved while it was mapped leaves surfaces behind in places that beams go through
// before and after; a layer's front is where beams that end on it come from; and a surface ends where they no longer
// do. README, "Free space" and "Trim".
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "mapping/beam.hpp"
#include "mapping/sub_mesh.hpp"

namespace lxd {

// Of one quad. When a count is full both are halved.
struct QuadBeams {
  static constexpr int kParts = 4;  // along each edge

  std::uint8_t passes = 0, ends = 0;
  std::uint16_t met = 0;  // parts that beams ended in: bit v * kParts + u

  static QuadBeams of(std::uint32_t bits) { return std::bit_cast<QuadBeams>(bits); }
  [[nodiscard]] std::uint32_t bits() const { return std::bit_cast<std::uint32_t>(*this); }

  // By what share of its width the quad sticks out beyond its beams at the sides low v, high u, high v, low u: what is
  // empty there, less what would be empty by chance if as many beams had ended all over it.
  [[nodiscard]] std::array<float, 4> overhang() const;
};

// The same for a quad that nobody saw and whose surface goes on at two adjacent sides only: half of it is taken to be
// empty, less what would be by chance if it were met as the seen ones of its layer are on average.
std::array<float, 4> overhang_of_notch(std::span<const std::uint32_t> layer_beams, std::uint32_t seen_quads);

inline constexpr std::size_t kBeamCounts = kLayerQuads + 1;

// Of each layer.
struct LayerVerdicts {
  std::span<std::uint32_t> quads;   // to export, bits as in Layer::seen_quads: those that more beams went through than
                                    // ended on go
  std::span<std::int8_t> sides;     // +1 or -1: on which side along its axis the LiDAR was; stays where no beams tell
  std::span<std::uint32_t> counts;  // kBeamCounts of each: QuadBeams of its quads, and a number to work with
};

// scratch: to work with, at least two; the more (up to 512 KiB) the faster. Low-priority thread.
void judge_by_beams(const SubMesh& sub_mesh, BeamSource& beams, float cell_size_m, const LayerVerdicts& verdicts,
                    std::span<std::uint32_t> scratch) noexcept;

}  // namespace lxd
