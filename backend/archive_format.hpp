// SPDX-License-Identifier: Apache-2.0
// What writer and reader of the map archive agree on: identification, tables and the packing of poses.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "backend/sqlite.hpp"
#include "backend/vertex_colour.hpp"
#include "mapping/mesh.hpp"
#include "rt/pose.hpp"
#include "rt/result.hpp"

namespace lxd {

inline constexpr std::uint32_t kArchiveApplicationId = 0x4C58444D;  // "LXDM"
// PRAGMA user_version. With the first colour an archive becomes the later one, which has one table more.
inline constexpr std::uint32_t kArchiveVersion = 2, kColouredArchiveVersion = 3;

// Blobs are the arrays as they lie in memory: little-endian, packed.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(MeshVertex) == 28 && sizeof(MeshFace) == 12 && sizeof(VertexColour) == 4);

inline constexpr const char* kArchiveSchema = R"(
  CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
  CREATE TABLE submesh (id INTEGER PRIMARY KEY, session INTEGER NOT NULL, piece INTEGER NOT NULL,
                        first_ns INTEGER NOT NULL, last_ns INTEGER NOT NULL,
                        T_map_submesh BLOB NOT NULL, vertices BLOB NOT NULL, faces BLOB NOT NULL);
  CREATE TABLE keyframe (submesh INTEGER NOT NULL, stamp_ns INTEGER NOT NULL, T_submesh_body BLOB NOT NULL,
                         PRIMARY KEY (submesh, stamp_ns)) WITHOUT ROWID;
  CREATE TABLE pose (session INTEGER NOT NULL, stamp_ns INTEGER NOT NULL, T_map_reference BLOB NOT NULL,
                     PRIMARY KEY (session, stamp_ns)) WITHOUT ROWID;
)";

inline constexpr const char* kColourSchema =
    "CREATE TABLE IF NOT EXISTS colour (submesh INTEGER PRIMARY KEY, colours BLOB NOT NULL);";

// Has it the table of colours?
Result<bool> has_colours(const Database& database);

// The upper three rows of the 4x4 matrix, row by row.
using PackedPose = std::array<double, 12>;
PackedPose pack(const Pose& T);
// Nothing when the blob is not twelve finite numbers.
std::optional<Pose> unpack_pose(std::span<const std::byte> blob);

// Reads SQLite's own file header (https://sqlite.org/fileformat2.html, section 1.3) and says in plain words why the
// file is no archive that this version can read, before SQLite would stumble over it.
Status check_archive_header(const std::filesystem::path& path);

}  // namespace lxd
