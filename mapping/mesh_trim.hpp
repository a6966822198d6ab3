// SPDX-License-Identifier: Apache-2.0
// A quad that was met in part reaches beyond the surface's edge: its open sides are drawn in to where its beams end.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mapping/lattice_entry.hpp"
#include "mapping/mesh_topology.hpp"

namespace lxd {

class MeshTrim {
 public:
  MeshTrim(MeshTopology& topology, std::span<LatticeEntry> storage) : topology_(topology), storage_(storage) {}

  // corners: of a quad whose faces are in the topology, at low u and v, high u, high u and v, high v.
  // overhang: as of QuadBeams, shares of the quad's width.
  void add(const std::array<std::uint32_t, 4>& corners, const std::array<float, 4>& overhang);

  // Moves each vertex by the mean of its pulls along u, then along v. Returns how many pulls found no room.
  [[nodiscard]] std::uint64_t apply();

 private:
  [[nodiscard]] bool is_open(std::uint32_t a, std::uint32_t b) const;
  void pull(std::uint32_t vertex, std::uint32_t inner, float share, std::uint32_t direction);

  MeshTopology& topology_;
  std::span<LatticeEntry> storage_;  // the first count_ of them are pulls
  std::size_t count_ = 0;
  std::uint64_t no_room_ = 0;
};

}  // namespace lxd
