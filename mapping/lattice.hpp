// SPDX-License-Identifier: Apache-2.0
// The lattice that the whole map hangs on: cubic cells of edge r_cell (paper, eq. of v = floor(p / r_cell)), and in
// each cell a grid of vertices for layers seen along one of the three axes. Every sub-mesh uses the same lattice, so
// that the border vertices of neighbouring cells, and of overlapping sub-meshes, lie on the same lattice lines.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace lxd {

inline constexpr int kQuadsPerEdge = 5;
inline constexpr int kVerticesPerEdge = kQuadsPerEdge + 1;  // both borders included: neighbours share them
inline constexpr int kLayerVertices = kVerticesPerEdge * kVerticesPerEdge;
inline constexpr int kLayerQuads = kQuadsPerEdge * kQuadsPerEdge;
inline constexpr int kLayersPerCell = 3;

inline constexpr std::uint32_t kNone = 0xFFFFFFFFu;  // "no such element" for every index of the map

using CellIndex = Eigen::Vector3i;

// One scalar a cell: 21 bits an axis, that is +-1,048,576 cells; beyond that the key is not unique.
using CellKey = std::uint64_t;

inline constexpr int kKeyBits = 21;
inline constexpr std::uint64_t kKeyMask = (std::uint64_t{1} << kKeyBits) - 1;
inline constexpr std::int32_t kKeyOffset = 1 << (kKeyBits - 1);

inline CellKey pack(const CellIndex& c) {
  const auto axis = [](std::int32_t i) { return static_cast<std::uint64_t>(i + kKeyOffset) & kKeyMask; };
  return axis(c.x()) << (2 * kKeyBits) | axis(c.y()) << kKeyBits | axis(c.z());
}

inline CellIndex unpack(CellKey key) {
  const auto axis = [key](int shift) { return static_cast<std::int32_t>(key >> shift & kKeyMask) - kKeyOffset; };
  return {axis(2 * kKeyBits), axis(kKeyBits), axis(0)};
}

// The lattice ends here, and each of its cells has neighbours whose keys are its own.
inline constexpr int kCellMax = kKeyOffset - 2;

// What lies beyond the lattice, or nowhere (NaN), is said to be in its last cell: diverging iterates ask for such
// places.
inline CellIndex cell_of(const Eigen::Vector3d& p_m, double inverse_cell_size) {
  const auto within = [](double c) { return c < kCellMax ? (c > -kCellMax ? c : -kCellMax) : kCellMax; };
  return (p_m * inverse_cell_size).array().floor().unaryExpr(within).cast<int>();
}

inline bool is_last_cell(const CellIndex& c) { return c.cwiseAbs().maxCoeff() >= kCellMax; }

// Finalizer of splitmix64 (Steele et al. 2014): neighbouring cells land far apart.
inline std::uint64_t scatter(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

// The two lattice axes of a layer that is a height over `axis`, right-handed: (u, v, axis) is a cyclic permutation.
constexpr int axis_u(int axis) { return (axis + 1) % 3; }
constexpr int axis_v(int axis) { return (axis + 2) % 3; }

}  // namespace lxd
