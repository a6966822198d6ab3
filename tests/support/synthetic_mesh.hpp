// SPDX-License-Identifier: Apache-2.0
// Meshes of flat patches for tests: rectangles of small triangles with the normal towards where the LiDAR was.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "backend/archive.hpp"
#include "mapping/mesh.hpp"

namespace lxd::test {

struct SyntheticMesh {
  std::vector<MeshVertex> vertices;
  std::vector<MeshFace> faces;

  // Rectangle from `corner` along u and v (m); its normal is u x v.
  void add_patch(const Eigen::Vector3f& corner, const Eigen::Vector3f& u, const Eigen::Vector3f& v,
                 float spacing_m = 0.25F) {
    const int nu = std::max(1, static_cast<int>(std::lround(u.norm() / spacing_m)));
    const int nv = std::max(1, static_cast<int>(std::lround(v.norm() / spacing_m)));
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const Eigen::Vector3f normal = u.cross(v).normalized();
    for (int j = 0; j <= nv; ++j)
      for (int i = 0; i <= nu; ++i) {
        const Eigen::Vector3f p = corner + u * (static_cast<float>(i) / static_cast<float>(nu)) +
                                  v * (static_cast<float>(j) / static_cast<float>(nv));
        vertices.push_back({p, normal, 1e-4F});
      }
    const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (nu + 1) + i); };
    for (int j = 0; j < nv; ++j)
      for (int i = 0; i < nu; ++i) {
        faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }

  // A room seen from within: floor, ceiling and four walls.
  void add_room(const Eigen::Vector3f& low, const Eigen::Vector3f& size) {
    const Eigen::Vector3f x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
    add_patch(low, x, y);
    add_patch(low + z, y, x);
    add_patch(low, z, x);
    add_patch(low + y, x, z);
    add_patch(low, y, z);
    add_patch(low + x, z, y);
  }

  // A box seen from without, standing on the floor.
  void add_box(const Eigen::Vector3f& low, const Eigen::Vector3f& size) {
    const Eigen::Vector3f x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
    add_patch(low + z, x, y);
    add_patch(low, x, z);
    add_patch(low + y, z, x);
    add_patch(low, z, y);
    add_patch(low + x, y, z);
  }

  [[nodiscard]] SubmeshView view(std::int64_t id, const Pose& T_map_submesh = {}) const {
    SubmeshView view;
    view.id = id;
    view.T_map_submesh = T_map_submesh;
    view.first = RigTime::from_ns(id);
    view.last = RigTime::from_ns(id + 1);
    view.vertices = vertices;
    view.faces = faces;
    return view;
  }
};

}  // namespace lxd::test
