// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/walls.hpp"

#include <algorithm>
#include <cmath>

namespace lxd::sim {
namespace {

constexpr double kPane_m = 0.01;
constexpr double kBar_m = 0.05;

// One wall, from its left end along x.
class WallBuilder {
 public:
  WallBuilder(MeshBuilder& mesh, const Wall& wall, Surface surface)
      : mesh_(mesh), thickness_m_(wall.thickness_m), surface_(surface) {
    const Eigen::Vector2d along = wall.to - wall.from;
    start_ = {{wall.from.x(), wall.from.y(), 0}, std::atan2(along.y(), along.x())};
  }

  void piece(double from, double to, double low, double high) { part(from, to, low, high, thickness_m_, surface_); }

  void glazing(const Opening& o) {
    part(o.from_m, o.to_m, o.low_m, o.high_m, kPane_m, Surface::glass);
    const double middle = (o.from_m + o.to_m) / 2;
    part(middle - kBar_m / 2, middle + kBar_m / 2, o.low_m, o.high_m, kBar_m, Surface::paint_white);
    for (const double z : {o.low_m, o.high_m - kBar_m})
      part(o.from_m, o.to_m, z, z + kBar_m, kBar_m, Surface::paint_white);
  }

  void door_frame(const Opening& o) {
    constexpr double kFrame_m = 0.06;
    constexpr double kInto_m = 0.01;  // over the wall's own ends
    const double proud = thickness_m_ + 0.04;
    part(o.from_m - kFrame_m, o.from_m + kInto_m, o.low_m, o.high_m, proud, Surface::wood);
    part(o.to_m - kInto_m, o.to_m + kFrame_m, o.low_m, o.high_m, proud, Surface::wood);
    part(o.from_m - kFrame_m, o.to_m + kFrame_m, o.high_m - kInto_m, o.high_m + kFrame_m, proud, Surface::wood);
  }

 private:
  void part(double from, double to, double low, double high, double thickness, Surface surface) {
    if (to - from <= 0 || high - low <= 0) return;
    mesh_.box(start_.moved((from + to) / 2, 0, low), {to - from, thickness, high - low}, surface);
  }

  MeshBuilder& mesh_;
  double thickness_m_;
  Surface surface_;
  Placement start_;
};

}  // namespace

void add_wall(MeshBuilder& mesh, Wall wall, Surface surface) {
  WallBuilder builder(mesh, wall, surface);
  std::ranges::sort(wall.openings, {}, &Opening::from_m);
  double from = 0;
  for (const Opening& opening : wall.openings) {
    builder.piece(from, opening.from_m, wall.low_m, wall.high_m);
    builder.piece(opening.from_m, opening.to_m, wall.low_m, opening.low_m);
    builder.piece(opening.from_m, opening.to_m, opening.high_m, wall.high_m);
    if (opening.glazed) {
      builder.glazing(opening);
    } else {
      builder.door_frame(opening);
    }
    from = opening.to_m;
  }
  builder.piece(from, (wall.to - wall.from).norm(), wall.low_m, wall.high_m);
}

void add_slab(MeshBuilder& mesh, const Rect& area, const Rect& hole, double low_m, double high_m, Surface surface) {
  const auto part = [&](double x0, double y0, double x1, double y1) {
    if (x1 > x0 && y1 > y0) mesh.block({x0, y0, low_m}, {x1, y1, high_m}, surface);
  };
  part(area.low.x(), area.low.y(), hole.low.x(), area.high.y());
  part(hole.high.x(), area.low.y(), area.high.x(), area.high.y());
  part(hole.low.x(), area.low.y(), hole.high.x(), hole.low.y());
  part(hole.low.x(), hole.high.y(), hole.high.x(), area.high.y());
}

}  // namespace lxd::sim
