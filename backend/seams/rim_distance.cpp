// SPDX-License-Identifier: Apache-2.0
#include "backend/seams/rim_distance.hpp"

#include <algorithm>

#include "mapping/lattice.hpp"

namespace lxd {
namespace {

// Around a vertex within the mesh each neighbour is the next corner of one face and the last of another: what is added
// for the one and taken for the other leaves nothing.
void mark_inner(std::size_t vertices, std::span<const MeshFace> faces, std::vector<std::uint8_t>& rings) {
  std::vector<std::uint64_t> open(vertices, 0);
  std::vector<bool> used(vertices, false);
  for (const MeshFace& face : faces)
    for (std::size_t i = 0; i < 3; ++i) {
      open[face[i]] += scatter(std::uint64_t{face[(i + 1) % 3]} + 1) - scatter(std::uint64_t{face[(i + 2) % 3]} + 1);
      used[face[i]] = true;
    }
  rings.resize(vertices);
  for (std::size_t i = 0; i < vertices; ++i) rings[i] = used[i] && open[i] == 0 ? kRingsMax : 0;
}

}  // namespace

void measure_rim_distance(std::size_t vertices, std::span<const MeshFace> faces, std::vector<std::uint8_t>& rings) {
  mark_inner(vertices, faces, rings);
  for (std::uint8_t ring = 1; ring < kRingsMax; ++ring)
    for (const MeshFace& face : faces) {
      const std::uint8_t nearest = std::min({rings[face[0]], rings[face[1]], rings[face[2]]});
      if (nearest != ring - 1) continue;
      for (const std::uint32_t v : face) rings[v] = std::min(rings[v], ring);
    }
}

}  // namespace lxd
