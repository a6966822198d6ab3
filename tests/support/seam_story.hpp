// SPDX-License-Identifier: Apache-2.0
// Maps of several sub-meshes, as they are exported: patches in, the fused surface out.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "backend/seams/fused_map.hpp"
#include "tests/support/synthetic_mesh.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::test {

// All that is exported, in the map's frame.
struct ExportedMap {
  SyntheticMesh mesh;
  std::vector<VertexColour> colours;
  std::vector<std::uint32_t> submesh_of_face;

  // How often a line along z meets the surface at (x, y), and where it does last.
  struct Sounding {
    int faces = 0;
    float z_m = 0;
  };
  [[nodiscard]] Sounding sound(float x, float y) const {
    Sounding found;
    for (const MeshFace& face : mesh.faces) {
      const Eigen::Vector3f &a = mesh.vertices[face[0]].position_m, &b = mesh.vertices[face[1]].position_m,
                            &c = mesh.vertices[face[2]].position_m;
      const auto cross = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& q) {
        return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
      };
      const float wa = cross(b, c), wb = cross(c, a), wc = cross(a, b);
      const bool inside = (wa > 0 && wb > 0 && wc > 0) || (wa < 0 && wb < 0 && wc < 0);
      if (!inside) continue;
      ++found.faces;
      found.z_m = (wa * a.z() + wb * b.z() + wc * c.z()) / (wa + wb + wc);
    }
    return found;
  }
};

// One at a time: a test's folder is one.
class SeamStory {
 public:
  static constexpr float kSpacing_m = 0.1F;

  // A sub-mesh of its own; `colour` of all its vertices.
  void add(const SyntheticMesh& mesh, const Pose& T_map_submesh = {}, const VertexColour& colour = {}) {
    parts_.push_back({mesh, T_map_submesh, colour});
  }

  // A level rectangle, seen from above.
  void add_floor(float x, float y, float size_x, float size_y, float z, float variance_m2 = 1e-4F,
                 const VertexColour& colour = {}) {
    SyntheticMesh mesh;
    mesh.add_patch({x, y, z}, {size_x, 0, 0}, {0, size_y, 0}, kSpacing_m);
    for (MeshVertex& v : mesh.vertices) v.variance_m2 = variance_m2;
    add(mesh, {}, colour);
  }

  [[nodiscard]] Archive archive() {
    const auto path = *folder_ / ("map" + std::to_string(archives_++) + ".db");
    auto writer = ArchiveWriter::create(path);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const auto id = static_cast<std::int64_t>(i);
      EXPECT_TRUE(writer->append(parts_[i].mesh.view(id, parts_[i].T_map_submesh)).ok());
      const std::vector<VertexColour> colours(parts_[i].mesh.vertices.size(), parts_[i].colour);
      EXPECT_TRUE(!parts_[i].colour.known() || writer->set_colours(id, colours).ok());
    }
    EXPECT_TRUE(writer->finish().ok());
    return std::move(Archive::open(path).value());
  }

  [[nodiscard]] ExportedMap fused() {
    const Archive map = archive();
    const auto fused = FusedMap::create(map, folder_->path());
    EXPECT_TRUE(fused.ok());
    ExportedMap out;
    EXPECT_TRUE(fused->for_each_submesh([&](const SubmeshView& s) { return append(s, out); }).ok());
    EXPECT_EQ(fused->totals().vertices, out.mesh.vertices.size());
    EXPECT_EQ(fused->totals().faces, out.mesh.faces.size());
    return out;
  }

  [[nodiscard]] const TemporaryFolder& folder() const { return *folder_; }

  [[nodiscard]] std::size_t faces() const {
    std::size_t faces = 0;
    for (const Part& part : parts_) faces += part.mesh.faces.size();
    return faces;
  }

 private:
  struct Part {
    SyntheticMesh mesh;
    Pose T_map_submesh;
    VertexColour colour;
  };

  static Status append(const SubmeshView& s, ExportedMap& out) {
    const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
    for (std::size_t i = 0; i < s.vertices.size(); ++i) {
      const MeshVertex& v = s.vertices[i];
      out.mesh.vertices.push_back({(s.T_map_submesh * v.position_m.cast<double>()).cast<float>(),
                                   (s.T_map_submesh.R * v.normal.cast<double>()).cast<float>(), v.variance_m2});
      out.colours.push_back(s.colours.empty() ? VertexColour{} : s.colours[i]);
    }
    for (const MeshFace& face : s.faces) {
      out.mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
      out.submesh_of_face.push_back(static_cast<std::uint32_t>(s.id));
    }
    return success();
  }

  std::unique_ptr<TemporaryFolder> folder_ = std::make_unique<TemporaryFolder>();  // so that stories can be moved
  std::vector<Part> parts_;
  int archives_ = 0;
};

}  // namespace lxd::test
