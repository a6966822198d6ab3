// SPDX-License-Identifier: Apache-2.0
// The Extended Scan Context of a place (paper, "Mesh-Centric Loop Closure via Extended Scan Context"): a polar grid
// about a key frame with three channels, height, confidence-weighted density and visibility.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "backend/loops/surfels.hpp"

namespace lxd {

inline constexpr int kContextRings = 24;    // N_r
inline constexpr int kContextSectors = 64;  // N_s
inline constexpr int kContextBins = kContextRings * kContextSectors;

struct ContextConfig {
  // Rings widen geometrically from the first to the last radius: one grid for rooms and for streets.
  double radius_min_m = 2.0;
  double radius_max_m = 80.0;
  double obstacle_min_m = 0.5;  // above the ground: lower tops are ground
};

enum class Visibility : std::uint8_t { unknown = 0, free = 1, occupied = 2 };

// Bin (ring, sector) is at ring * kContextSectors + sector.
struct ScanContext {
  static constexpr double kHeightStep_m = 0.1;      // of the height channel: 0 .. 25.5 m
  static constexpr double kDensityStep = 1 / 16.0;  // octaves of D(r, theta) over kDensityOffset
  static constexpr double kDensityOffset = 8;       // octaves: a lone vertex of a few centimetres

  std::array<std::uint8_t, kContextBins> height{};    // of the highest surface above the ground
  std::array<std::uint8_t, kContextBins> density{};   // logarithm of D(r, theta)
  std::array<Visibility, kContextBins> visibility{};  // what a ray from the key frame meets

  static constexpr std::size_t bin(int ring, int sector) {
    return static_cast<std::size_t>(ring * kContextSectors + sector);
  }
};

using RingKey = std::array<float, kContextRings>;  // invariant to heading: a ring's mean height where it was seen, m

// `surfels` in their sub-mesh's frame, whose z is up; `place_m` is the key frame in it. The sectors count from that
// frame's x axis towards y: the heading of the carrier is of no account.
ScanContext make_scan_context(std::span<const Surfel> surfels, const Eigen::Vector3d& place_m,
                              const ContextConfig& config);

// Of a place relative to the key frame; unknown beyond the last ring.
Visibility visibility_at(const ScanContext& context, const Eigen::Vector3d& d_m, const ContextConfig& config);

RingKey ring_key(const ScanContext& context);

// Height of the place above the ground near it, m; 0 where there is none.
double height_above_ground_m(std::span<const Surfel> surfels, const Eigen::Vector3d& place_m);

}  // namespace lxd
