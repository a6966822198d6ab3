// SPDX-License-Identifier: Apache-2.0
// Capacities of the default board profile: everything that the runtime will ever hold, as compile-time constants.
// A profile for another board is another folder with a file of this name.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lxd::capacities {

inline constexpr std::size_t kMebibyte = 1024 * 1024;

// Ceiling of the whole process's peak resident memory under this profile.
inline constexpr std::size_t kPeakRssBytes = 512 * kMebibyte;
// The back-end's share of it: places and surfaces that loops are sought among, at most (8192 of 5 kB, 8 million of
// 10 B), what a camera saw at key frames (768 of 128 features, 14 MB with their index), and the graph.
inline constexpr std::size_t kBackEndBytes = 134 * kMebibyte;
// Colours: images that wait for the sub-meshes that they show (150 to 200 of 320 pixels' length), and what is known of
// the vertices of the one whose colours are told.
inline constexpr std::size_t kKeyImageBytes = 32 * kMebibyte;
// Grey images that wait until a key frame asks for them: 13 of 640 x 480, a second at 10 Hz.
inline constexpr std::size_t kSightImageBytes = 4 * kMebibyte;
// What the program, its libraries, stacks and the triangles on their way into files take beside the arena: 120 MiB were
// measured (KITTI raw drive 0005, at the run's end, without the back-end).
inline constexpr std::size_t kOutsideArenaBytes = 124 * kMebibyte + kBackEndBytes;
// The one static block that every pool of the runtime is cut from.
inline constexpr std::size_t kArenaBytes = kPeakRssBytes - kOutsideArenaBytes;

// 128 beams x 2048 columns, the densest single-return sweep of the supported sensors.
inline constexpr std::size_t kSweepPointsMax = 262'144;
// One being read, one being registered, and four that come at once when a wire was held up for 0.4 s: the newest of
// them is the one that is wanted.
inline constexpr std::size_t kSweepsInFlight = 6;

// Of each of the four sub-meshes. 40 m of a street (KITTI raw drive 0005) take 58,000 fine cells and 33,000 layers.
inline constexpr std::uint32_t kFineCells = 65'536;
inline constexpr std::uint32_t kFineLayers = 40'960;
inline constexpr std::uint32_t kFineWaitingBlocks = 24'576;
inline constexpr std::uint32_t kCoarseCells = 12'288;
inline constexpr std::uint32_t kCoarseLayers = 8'192;
inline constexpr std::uint32_t kCoarseWaitingBlocks = 6'144;
// Points of a sweep that take part in the update, and those of the cloud.
inline constexpr std::uint32_t kRegistrationPointsMax = 8'192;

// The mesh of one sub-mesh while it is extracted. That street takes 23 vertices and 40 faces a layer, three quarters of
// its vertices on open edges before seams are closed.
inline constexpr std::uint32_t kMeshCorners = 700'000;
inline constexpr std::uint32_t kMeshVertices = 950'000;
inline constexpr std::uint32_t kMeshFaces = 1'400'000;
inline constexpr std::uint32_t kMeshBoundary = 640'000;

static_assert(kArenaBytes < kPeakRssBytes);

}  // namespace lxd::capacities
