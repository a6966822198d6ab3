// SPDX-License-Identifier: Apache-2.0
// Projection, culling and shading of the mesh.
#include "backend/overview_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "backend/overview_palette.hpp"

namespace lxd {
namespace {

// A surface whose normal is this far from the eye's direction is seen edge-on: drawn by its edges.
constexpr double kEdgeOnCosine = 0.12;
constexpr float kAmbient = 0.38F;
constexpr float kColouredAmbient = 0.75F;  // images have light and shade of their own

struct MapVertex {
  Eigen::Vector3d p;
  Eigen::Vector3d normal;
  Colour colour;  // its own; in a map without colours it is not looked at
};

using Triangle = std::array<MapVertex, 3>;

bool finite(const Triangle& t) {
  return std::ranges::all_of(t, [](const MapVertex& v) { return v.p.allFinite() && v.normal.allFinite(); });
}

class Painter {
 public:
  Painter(const Interval& heights, bool coloured) : heights_(heights), coloured_(coloured) {}

  void paint(const Triangle& t, Panel& panel) const {
    const Eigen::Vector3d eye = panel.view.R_view_map.row(2).transpose();
    const double facing = eye.dot(t[0].normal + t[1].normal + t[2].normal) / 3;
    if (facing < -kEdgeOnCosine) return;  // seen from behind: a ceiling, a near wall
    std::array<Raster::Corner, 3> corners;
    std::array<Colour, 3> colours;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = panel.view.project(t[i].p);
      colours[i] = shade(t[i], eye);
    }
    if (facing > 0) panel.raster.triangle(corners, colours);
    if (facing > kEdgeOnCosine) return;
    // Lighter than what lies flat: the outline of a room.
    for (std::size_t i = 0; i < 3; ++i)
      panel.raster.line(corners[i], corners[(i + 1) % 3], 0.5F * (kInk + own_colour(t[i])));
  }

 private:
  // 0..1
  [[nodiscard]] double height_of(const MapVertex& v) const {
    constexpr double kSpanMin_m = 1e-3;
    return (v.p.z() - heights_.low) / std::max(heights_.high - heights_.low, kSpanMin_m);
  }

  [[nodiscard]] Colour shade(const MapVertex& v, const Eigen::Vector3d& eye) const {
    // The light comes over the left shoulder: walls of different directions differ.
    const Eigen::Vector3d light = (eye + Eigen::Vector3d(-0.35, 0.20, 0.35)).normalized();
    const auto lit = static_cast<float>(std::clamp(v.normal.dot(light), 0.0, 1.0));
    const float ambient = coloured_ ? kColouredAmbient : kAmbient;
    return (ambient + (1 - ambient) * lit) * own_colour(v);
  }

  [[nodiscard]] Colour own_colour(const MapVertex& v) const {
    return coloured_ ? v.colour : height_colour(height_of(v));
  }

  Interval heights_;
  bool coloured_;
};

Colour seen_colour(const SubmeshView& submesh, std::uint32_t vertex) {
  constexpr float kLevelMax = 255, kUnseen = 0.5F;  // what no camera saw stands back
  const VertexColour colour = submesh.colours.empty() ? VertexColour{} : submesh.colours[vertex];
  return (colour.known() ? 1 : kUnseen) * Colour(colour.red, colour.green, colour.blue) / kLevelMax;
}

Triangle triangle_of(const SubmeshView& submesh, const MeshFace& face) {
  Triangle t;
  for (std::size_t i = 0; i < 3; ++i) {
    const MeshVertex& v = submesh.vertices[face[i]];
    t[i] = {submesh.T_map_submesh * v.position_m.cast<double>(), submesh.T_map_submesh.R * v.normal.cast<double>(),
            seen_colour(submesh, face[i])};
  }
  return t;
}

}  // namespace

Result<std::vector<Eigen::Vector3d>> sample_vertices(const Archive& archive) {
  const std::uint64_t stride = archive.totals().vertices / kSamplesMax + 1;
  std::vector<Eigen::Vector3d> samples;
  std::uint64_t seen = 0;
  const Status read = archive.for_each_submesh([&](const SubmeshView& submesh) {
    for (const MeshVertex& v : submesh.vertices) {
      const Eigen::Vector3d p = submesh.T_map_submesh * v.position_m.cast<double>();
      if (seen++ % stride == 0 && p.allFinite()) samples.push_back(p);
    }
    return success();
  });
  if (!read.ok()) return read.error();
  return samples;
}

Status draw_mesh(const Archive& archive, const Interval& heights, Panel& panel) {
  const Painter painter(heights, archive.totals().coloured());
  return archive.for_each_submesh([&](const SubmeshView& submesh) {
    for (const MeshFace& face : submesh.faces) {
      const Triangle t = triangle_of(submesh, face);
      if (finite(t)) painter.paint(t, panel);
    }
    return success();
  });
}

}  // namespace lxd
