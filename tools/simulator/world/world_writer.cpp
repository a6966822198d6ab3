// SPDX-License-Identifier: Apache-2.0
// The world as PLY (Turk 1994), of positions and triangles; `glass` of a face as the evaluation reads it.
#include <bit>

#include <fmt/format.h>

#include "backend/part_file.hpp"
#include "tools/simulator/world/world_file.hpp"

namespace lxd::sim {

static_assert(std::endian::native == std::endian::little, "the file's byte order is the machine's");

Status write_world_ply(const std::filesystem::path& path, const World& world) {
  Result<PartFile> file = PartFile::create(path);
  if (!file.ok()) return file.error();
  file->write_text(
      fmt::format("ply\nformat binary_little_endian 1.0\ncomment true surfaces without movers, metres; glass returns "
                  "nothing\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face {}\nproperty list uchar int vertex_indices\nproperty uchar glass\nend_header\n",
                  world.vertices.size(), world.faces.size()));
  for (const Eigen::Vector3f& vertex : world.vertices) file->write_values(std::span<const float>(vertex.data(), 3));
  for (std::size_t i = 0; i < world.faces.size(); ++i) {
    file->write_value(std::uint8_t{3});
    file->write_values(std::span<const std::uint32_t>(world.faces[i]));
    file->write_value(static_cast<std::uint8_t>(world.materials[world.face_material[i]].glass ? 1 : 0));
  }
  return file->commit();
}

}  // namespace lxd::sim
