// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/world_file.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "tools/evaluate/triangle_mesh.hpp"
#include "tools/simulator/world/obj_file.hpp"

namespace lxd::sim {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

Result<TriangleMesh> load_mesh(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return Error{fmt::format("{}: cannot be read: {}", path.string(), error.message())};
  if (bytes > kWorldFileBytesMax)
    return Error{fmt::format("{}: found {} bytes, wanted at most {}", path.string(), bytes, kWorldFileBytesMax)};
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return load_mesh_ply(path);
  if (extension == ".obj") return load_mesh_obj(path);
  return Error{fmt::format("{}: found the ending '{}', wanted .ply or .obj", path.string(), extension)};
}

// The cause when this mesh is no world, else empty.
std::string unfit(const TriangleMesh& mesh) {
  if (mesh.faces.empty()) return "found no face, wanted at least one";
  if (mesh.faces.size() > kWorldFacesMax)
    return fmt::format("found {} triangles, wanted at most {}", mesh.faces.size(), kWorldFacesMax);
  const auto far = std::ranges::find_if(
      mesh.vertices_m, [](const Eigen::Vector3d& p) { return !(p.cwiseAbs().maxCoeff() <= kWorldReach_m); });
  if (far == mesh.vertices_m.end()) return "";
  return fmt::format("vertex {}: found ({}, {}, {}), wanted within {} m of the origin (move the mesh there)",
                     far - mesh.vertices_m.begin(), far->x(), far->y(), far->z(), kWorldReach_m);
}

}  // namespace

Result<World> load_world(const std::filesystem::path& path) {
  const Result<TriangleMesh> mesh = load_mesh(path);
  if (!mesh.ok()) return mesh.error();
  if (const std::string wrong = unfit(*mesh); !wrong.empty()) return Error{fmt::format("{}: {}", path.string(), wrong)};
  World world;
  world.name = path.stem().string();
  world.materials.push_back({.name = "surface", .albedo = 0.5F, .contrast = 0.5F, .texel_m = 0.4F});
  for (const Eigen::Vector3d& vertex : mesh->vertices_m) world.vertices.emplace_back(vertex.cast<float>());
  world.faces = mesh->faces;
  world.face_material.assign(world.faces.size(), 0);
  if (mesh->glass.empty()) return world;
  world.materials.push_back({.name = "glass", .glass = true});
  std::ranges::copy(mesh->glass, world.face_material.begin());
  return world;
}

}  // namespace lxd::sim
