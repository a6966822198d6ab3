// SPDX-License-Identifier: Apache-2.0
// PLY mesh of the whole map. Two passes over it: all vertices, then all faces, as PLY wants them.
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "backend/mesh_export.hpp"
#include "backend/part_file.hpp"
#include "backend/seams/fused_map.hpp"

namespace lxd {
namespace {

constexpr std::uint64_t kVerticesMax = std::numeric_limits<std::int32_t>::max();  // PLY faces hold `int`

constexpr const char* kMeshColourProperties =
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar views\n";

std::string header(const ArchiveTotals& totals) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment LXD-SLAM mesh; metres, map frame; variance in m^2 along the "
      "normal\n"
      "element vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float variance\n{}"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      totals.vertices, totals.coloured() ? kMeshColourProperties : "", totals.faces);
}

MeshVertex to_map(const Pose& T_map_submesh, const MeshVertex& v) {
  return {(T_map_submesh * v.position_m.cast<double>()).cast<float>(),
          (T_map_submesh.R * v.normal.cast<double>()).cast<float>(), v.variance_m2};
}

struct __attribute__((packed)) PlyFace {
  std::uint8_t count = 3;
  std::array<std::uint32_t, 3> vertices;
};
static_assert(sizeof(PlyFace) == 13);

PlyFace shifted(const MeshFace& face, std::uint32_t first) {
  return {3, {face[0] + first, face[1] + first, face[2] + first}};
}

Status write_vertices(PartFile& file, const SubmeshView& submesh, bool coloured) {
  for (std::size_t i = 0; i < submesh.vertices.size(); ++i) {
    file.write_value(to_map(submesh.T_map_submesh, submesh.vertices[i]));
    if (coloured) file.write_value(submesh.colours.empty() ? VertexColour{} : submesh.colours[i]);
  }
  return file.status();
}

Status write_faces(PartFile& file, const SubmeshView& submesh, std::uint32_t first) {
  for (const MeshFace& face : submesh.faces) file.write_value(shifted(face, first));
  return file.status();
}

}  // namespace

Status write_mesh_ply(const std::filesystem::path& path, const Archive& archive) {
  const Result<FusedMap> map = FusedMap::create(archive, path.parent_path());
  if (!map.ok()) return map.error();
  if (map->totals().vertices > kVerticesMax)
    return Error{
        fmt::format("{}: PLY holds {} vertices, the map has {}", path.string(), kVerticesMax, map->totals().vertices)};
  Result<PartFile> file = PartFile::create(path);
  if (!file.ok()) return file.error();
  file->write_text(header(map->totals()));
  const bool coloured = map->totals().coloured();
  const Status vertices =
      map->for_each_submesh([&](const SubmeshView& submesh) { return write_vertices(*file, submesh, coloured); });
  if (!vertices.ok()) return vertices;
  std::uint32_t first = 0;
  const Status faces = map->for_each_submesh([&](const SubmeshView& submesh) {
    const Status written = write_faces(*file, submesh, first);
    first += static_cast<std::uint32_t>(submesh.vertices.size());
    return written;
  });
  return faces.ok() ? file->commit() : faces;
}

}  // namespace lxd
