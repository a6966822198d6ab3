// SPDX-License-Identifier: Apache-2.0
// What the mesh extraction sorts: one storage serves its steps one after the other.
#pragma once

#include <cstdint>
#include <tuple>

namespace lxd {

// A layer's vertex on its lattice line, its quad on the lattice square, or a pull at a vertex of the mesh.
struct LatticeEntry {
  std::uint64_t key;   // packed line (or square) and side; 2 * vertex + direction
  float order;         // height of a corner, m; rank of a quad, lowest first; share of a pull
  std::uint32_t slot;  // layer * kLayerVertices + vertex (or quad); the vertex that a pull goes to
};

inline bool operator<(const LatticeEntry& a, const LatticeEntry& b) {
  return std::tie(a.key, a.order, a.slot) < std::tie(b.key, b.order, b.slot);
}

}  // namespace lxd
