// SPDX-License-Identifier: Apache-2.0
// A map whose sub-meshes meet: what an archive holds, with one layer left where several sub-meshes show one surface
// (README, "Seams"). The archive stays as it is. Memory is that of one sub-mesh, or of what lies in one tile; a scratch
// file on the disk takes some 60 bytes a vertex while this lives.
#pragma once

#include <filesystem>
#include <optional>

#include "backend/archive.hpp"
#include "backend/seams/tile_store.hpp"
#include "rt/result.hpp"

namespace lxd {

class FusedMap {
 public:
  // folder: has room for the scratch file. The archive is read on, and outlives this. A map of one sub-mesh is as it
  // was, to the bit. Error: a damaged archive, the disk.
  static Result<FusedMap> create(const Archive& archive, const std::filesystem::path& folder);

  // Vertices and faces are those that are left.
  [[nodiscard]] const ArchiveTotals& totals() const { return totals_; }
  // As Archive's. Sub-meshes keep their frames; where two meet their vertices are at one place of the map.
  [[nodiscard]] Status for_each_submesh(const Archive::SubmeshVisitor& visit) const;

 private:
  explicit FusedMap(const Archive& archive) : archive_(&archive), totals_(archive.totals()) {}
  Status store(const std::filesystem::path& folder, const SeamScale& scale);
  Status fuse_tiles(const SeamScale& scale);
  Status count();

  const Archive* archive_;
  std::optional<TileStore> tiles_;  // none: there is nothing to fuse
  ArchiveTotals totals_;
};

}  // namespace lxd
