// SPDX-License-Identifier: Apache-2.0
// The world as PLY (Turk 1994), of positions and triangles.
#include <array>
#include <bit>
#include <limits>

#include <fmt/format.h>

#include "backend/part_file.hpp"
#include "tools/simulator/world/world_file.hpp"

namespace lxd::sim {
namespace {

static_assert(std::endian::native == std::endian::little, "the file's byte order is the machine's");

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

// What of a world is written, numbered anew.
struct Selection {
  std::vector<std::uint32_t> vertices;  // of the world, in the order of the file
  std::vector<std::uint32_t> number;    // of the world's vertices in the file
  std::vector<std::array<std::uint32_t, 3>> faces;

  explicit Selection(const World& world) : number(world.vertices.size(), kUnused) {
    for (std::size_t i = 0; i < world.faces.size(); ++i) {
      if (world.materials[world.face_material[i]].glass) continue;
      std::array<std::uint32_t, 3> face = world.faces[i];
      for (std::uint32_t& corner : face) corner = numbered(corner);
      faces.push_back(face);
    }
  }

 private:
  std::uint32_t numbered(std::uint32_t vertex) {
    if (number[vertex] == kUnused) {
      number[vertex] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(vertex);
    }
    return number[vertex];
  }
};

}  // namespace

Status write_world_ply(const std::filesystem::path& path, const World& world) {
  Result<PartFile> file = PartFile::create(path);
  if (!file.ok()) return file.error();
  const Selection selection(world);
  file->write_text(
      fmt::format("ply\nformat binary_little_endian 1.0\ncomment true surfaces without glass and movers, metres\n"
                  "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                  selection.vertices.size(), selection.faces.size()));
  for (const std::uint32_t vertex : selection.vertices)
    file->write_values(std::span<const float>(world.vertices[vertex].data(), 3));
  for (const auto& face : selection.faces) {
    file->write_value(std::uint8_t{3});
    file->write_values(std::span<const std::uint32_t>(face));
  }
  return file->commit();
}

}  // namespace lxd::sim
