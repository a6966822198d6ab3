// SPDX-License-Identifier: Apache-2.0
// Worlds from files: any mesh that a user names; and the mesh that goes beside a recording.
#pragma once

#include <filesystem>

#include "rt/result.hpp"
#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

// What a mesh file may hold at most. Coordinates: beyond this a float no longer tells half a millimetre.
inline constexpr double kWorldReach_m = 8192;
inline constexpr std::uintmax_t kWorldFileBytesMax = std::uintmax_t{1} << 31U;
inline constexpr std::size_t kWorldFacesMax = 20'000'000;

// By its ending: .ply (ascii or binary of either byte order) or .obj, in metres with z up. One material, and glass
// where a .ply has it (`glass` = 1 of a face); no movers, no routes. Error: file, place, found, wanted.
Result<World> load_world(const std::filesystem::path& path);

// The world without its movers, binary little-endian PLY. Faces have `glass` = 1 where a LiDAR gets nothing back, for
// they hide from it what is behind. Whole or not at all. Error: file, cause.
Status write_world_ply(const std::filesystem::path& path, const World& world);

}  // namespace lxd::sim
