// SPDX-License-Identifier: Apache-2.0
// The map archive `map.db`: one SQLite file that holds what a run made (sub-meshes, path, run facts) and survives the
// power being cut while it is written. The back-end's thread writes; anyone may read a finished archive.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "backend/sqlite.hpp"
#include "backend/trajectory.hpp"
#include "backend/vertex_colour.hpp"
#include "mapping/mesh.hpp"
#include "rt/pose.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

// Where the body was while a sub-mesh was built; goes with it, wherever it is moved.
struct SubmeshKeyFrame {
  RigTime stamp;
  Pose T_submesh_body;
};

// One sub-mesh, lent: its vertices are in its own frame, its faces count from its own first vertex.
struct SubmeshView {
  std::int64_t id = 0;
  std::int64_t session = 0;  // that mapped it: 0, 1, ... of those that the archive holds
  std::int64_t piece = 0;    // 0: the map; others lie in frames of their own, since nobody knows where they belong
  Pose T_map_submesh;
  RigTime first;  // sweeps that built it
  RigTime last;
  std::span<const MeshVertex> vertices;
  std::span<const MeshFace> faces;
  std::span<const SubmeshKeyFrame> key_frames;  // in order of time
  std::span<const VertexColour> colours;        // one a vertex; empty: no camera saw any
};

// What a lent sub-mesh's surface is stored in.
struct SubmeshSurface {
  std::vector<MeshVertex> vertices;
  std::vector<MeshFace> faces;
  std::vector<VertexColour> colours;
};

class ArchiveWriter {
 public:
  // Replaces an archive that is already there. Error: the folder is missing or read-only, or the disk is full.
  static Result<ArchiveWriter> create(const std::filesystem::path& path);

  Status set_meta(std::string_view key, std::string_view value);
  // Each call is one transaction: after a crash it is there whole or not at all. A sub-mesh of the same id (a pose of
  // the same stamp) is replaced, so that a growing sub-mesh may be stored again.
  Status append(const SubmeshView& submesh);
  // Colours of a sub-mesh that is there, one a vertex.
  Status set_colours(std::int64_t submesh, std::span<const VertexColour> colours);
  // Moves a sub-mesh that is there.
  Status set_pose(std::int64_t submesh, const Pose& T_map_submesh, std::int64_t piece = 0);
  Status append_poses(std::span<const StampedPose> poses, std::int64_t session = 0);
  // All that `work` does is one transaction, and nothing of it when it fails.
  Status all_or_nothing(const std::function<Status()>& work);
  // Folds the write-ahead log into the one file, which can then be read from read-only media too. Last call.
  Status finish();

 private:
  explicit ArchiveWriter(Database database) : database_(std::move(database)) {}
  Status append_key_frames(const SubmeshView& submesh);
  Status forget_colours(std::int64_t submesh);

  Database database_;
};

// Of the map, which is piece 0; poses of the latest session.
struct ArchiveTotals {
  std::uint64_t submeshes = 0;
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  std::uint64_t poses = 0;
  std::uint64_t submeshes_apart = 0;  // of other pieces
  std::int64_t sessions = 0;
  std::int64_t last_id = -1;  // of any sub-mesh
  std::uint64_t submeshes_coloured = 0;

  [[nodiscard]] bool coloured() const { return submeshes_coloured > 0; }
};

class Archive {
 public:
  // Read-only. Error: missing, not an archive, of another version, truncated; the message says which.
  static Result<Archive> open(const std::filesystem::path& path);

  [[nodiscard]] const ArchiveTotals& totals() const { return totals_; }
  [[nodiscard]] Result<std::map<std::string, std::string>> meta() const;
  // The map's, in order of id, one at a time: memory is that of the largest sub-mesh, twice. Stops at the visitor's
  // first error. Faces are checked to name vertices that exist. Error: damaged record (which), or the visitor's own.
  using SubmeshVisitor = std::function<Status(const SubmeshView&)>;
  [[nodiscard]] Status for_each_submesh(const SubmeshVisitor& visit) const;
  // The same for one who changes what is lent, in place: the archive keeps what it has.
  using SubmeshEditor = std::function<Status(const SubmeshView&, SubmeshSurface&)>;
  [[nodiscard]] Status edit_each_submesh(const SubmeshEditor& edit) const;
  // The surface of one alone. False: it has none such, or it is damaged.
  [[nodiscard]] bool read_vertices(std::int64_t submesh, std::vector<MeshVertex>& vertices) const;
  // Its colours. False: it has none, or they are damaged.
  [[nodiscard]] bool read_colours(std::int64_t submesh, std::vector<VertexColour>& colours) const;
  // Of a session, else of the latest; in order of time.
  [[nodiscard]] Result<std::vector<StampedPose>> poses(std::optional<std::int64_t> session = std::nullopt) const;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  Archive(std::filesystem::path path, Database database) : path_(std::move(path)), database_(std::move(database)) {}
  Status count();
  Status count_coloured();

  std::filesystem::path path_;
  Database database_;
  ArchiveTotals totals_;
};

}  // namespace lxd
