// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/facade.hpp"

#include <algorithm>
#include <cmath>

namespace lxd::sim {
namespace {

// How one house's storeys and windows are cut.
struct Style {
  Surface wall;
  double bay_m, storey_m;   // wanted; fitted to the facade
  double window_width;      // of the bay
  double sill_m, window_m;  // above the storey's floor; height
  double recess_m;
  bool balconies, pilasters;

  static Style random(Random& random) {
    static constexpr Surface kWalls[] = {Surface::plaster, Surface::plaster_warm, Surface::brick, Surface::stone,
                                         Surface::concrete};
    Style style{};
    style.wall = kWalls[random.bits() % std::size(kWalls)];
    style.bay_m = random.uniform(2.4, 4);
    style.storey_m = random.uniform(2.9, 3.5);
    style.window_width = random.uniform(0.35, 0.65);
    style.sill_m = random.uniform(0.6, 1.0);
    style.window_m = random.uniform(1.2, 1.7);
    style.recess_m = random.uniform(0.1, 0.35);
    style.balconies = random.chance(0.4);
    style.pilasters = random.chance(0.3);
    return style;
  }
};

// A wall's own coordinates: s along it, z up from its foot, out of the house.
struct Face {
  Placement at;  // x along the wall, y out of it; foot at the wall's left end at floor height
  double width_m, height_m, cellar_m;

  [[nodiscard]] Eigen::Vector3d point(double s, double z, double out = 0) const { return at.at(s, out, z); }
};

struct Span {
  double low, high;
};

class FacadeBuilder {
 public:
  FacadeBuilder(MeshBuilder& mesh, Random& random, const Style& style, const Face& face)
      : mesh_(mesh), random_(random), style_(style), face_(face) {}

  void build() {
    const int bays = std::max(1, static_cast<int>(face_.width_m / style_.bay_m));
    const int storeys = std::max(1, static_cast<int>((face_.height_m - 0.4) / style_.storey_m));
    const double bay = face_.width_m / bays;
    const int door = static_cast<int>(random_.bits() % static_cast<unsigned>(bays));
    flat({0, face_.width_m}, {-face_.cellar_m, 0});
    for (int storey = 0; storey < storeys; ++storey)
      for (int i = 0; i < bays; ++i)
        cell({i * bay, (i + 1) * bay}, storey * style_.storey_m, storey == 0 && i == door, storey > 0);
    flat({0, face_.width_m}, {storeys * style_.storey_m, face_.height_m});
    ornaments(bays, bay);
  }

 private:
  void flat(const Span& s, const Span& z) {
    mesh_.quad(face_.point(s.low, z.low), face_.point(s.high, z.low), face_.point(s.high, z.high),
               face_.point(s.low, z.high), style_.wall);
  }

  void cell(const Span& s, double floor, bool door, bool upper) {
    const double top = floor + style_.storey_m;
    if (!door && random_.chance(upper ? 0.08 : 0.25)) return flat(s, {floor, top});
    const double margin = (s.high - s.low) * (1 - style_.window_width) / 2;
    const Span hole{s.low + margin, s.high - margin};
    const Span up{floor + (door ? 0.02 : style_.sill_m), floor + (door ? 2.2 : style_.sill_m + style_.window_m)};
    flat(s, {floor, up.low});
    flat(s, {up.high, top});
    flat({s.low, hole.low}, up);
    flat({hole.high, s.high}, up);
    recess(hole, up, door ? 0.5 : style_.recess_m, door ? Surface::wood_dark : Surface::glass);
    if (upper && style_.balconies && random_.chance(0.3)) balcony(s, floor);
  }

  void recess(const Span& s, const Span& z, double depth, Surface pane) {
    const auto reveal = [&](double s0, double z0, double s1, double z1) {
      mesh_.quad(face_.point(s0, z0), face_.point(s1, z1), face_.point(s1, z1, -depth), face_.point(s0, z0, -depth),
                 style_.wall);
    };
    reveal(s.low, z.low, s.high, z.low);
    reveal(s.low, z.high, s.high, z.high);
    reveal(s.low, z.low, s.low, z.high);
    reveal(s.high, z.low, s.high, z.high);
    mesh_.quad(face_.point(s.low, z.low, -depth), face_.point(s.high, z.low, -depth),
               face_.point(s.high, z.high, -depth), face_.point(s.low, z.high, -depth), pane);
    if (pane != Surface::glass) return;
    constexpr double kBar_m = 0.07;  // a frame's bar across the pane, and one upright
    const double middle = (s.low + s.high) / 2;
    const double across = z.low + 0.7 * (z.high - z.low);
    bar({middle - kBar_m / 2, middle + kBar_m / 2}, z, -depth + 0.03);
    bar(s, {across - kBar_m / 2, across + kBar_m / 2}, -depth + 0.03);
    mesh_.box(face_.at.moved(middle, 0.02, z.low - 0.06), {s.high - s.low + 0.2, 0.14, 0.06}, Surface::concrete);
  }

  void bar(const Span& s, const Span& z, double out) {
    mesh_.quad(face_.point(s.low, z.low, out), face_.point(s.high, z.low, out), face_.point(s.high, z.high, out),
               face_.point(s.low, z.high, out), Surface::paint_white);
  }

  void balcony(const Span& s, double floor) {
    const Placement middle = face_.at.moved((s.low + s.high) / 2, kBalcony_m / 2, floor);
    const double width = 0.9 * (s.high - s.low);
    mesh_.box(middle.moved(0, 0, -0.1), {width, kBalcony_m, 0.15}, Surface::concrete);
    mesh_.box(middle.moved(0, kBalcony_m / 2 - 0.05, 0.05), {width, 0.05, 0.95}, Surface::metal);
  }

  void ornaments(int bays, double bay) {
    const double foot = -face_.cellar_m;
    mesh_.cylinder(face_.point(0.3, foot, 0.08), face_.point(0.3, face_.height_m, 0.08), 0.06, 0.06, 8, Surface::metal);
    if (style_.pilasters)
      for (int i = 1; i < bays; ++i)
        mesh_.box(face_.at.moved(i * bay, 0.05, foot), {0.35, 0.2, face_.height_m - foot}, Surface::concrete);
    mesh_.box(face_.at.moved(face_.width_m / 2, 0.05, face_.height_m - 0.15), {face_.width_m + 0.3, 0.4, 0.3},
              Surface::concrete);
  }

  MeshBuilder& mesh_;
  Random& random_;
  const Style& style_;
  const Face& face_;
};

void add_roof(MeshBuilder& mesh, const Placement& at, const Eigen::Vector2d& half, bool pitched, Surface gable) {
  const std::array<Eigen::Vector3d, 4> eaves{at.at(-half.x(), -half.y(), 0), at.at(half.x(), -half.y(), 0),
                                             at.at(half.x(), half.y(), 0), at.at(-half.x(), half.y(), 0)};
  if (!pitched) return mesh.quad(eaves[0], eaves[1], eaves[2], eaves[3], Surface::concrete);
  const Eigen::Vector3d rear = at.at(-half.x(), 0, 0.7 * half.y());
  const Eigen::Vector3d front = at.at(half.x(), 0, 0.7 * half.y());
  mesh.quad(eaves[0], eaves[1], front, rear, Surface::brick);
  mesh.quad(eaves[3], eaves[2], front, rear, Surface::brick);
  mesh.triangle(eaves[0], eaves[3], rear, gable);
  mesh.triangle(eaves[1], eaves[2], front, gable);
}

}  // namespace

void add_house(MeshBuilder& mesh, Random& random, const Ground& ground, const House& house) {
  constexpr double kBelow_m = 1;  // walls begin this far below the lowest ground at their corners
  constexpr double kPitchedMax_m = 11;
  const Placement flat{{house.centre.x(), house.centre.y(), 0}, house.yaw_rad};
  const std::array<Eigen::Vector2d, 4> corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  double low = ground.height_m(house.centre);
  double high = low;
  for (const Eigen::Vector2d& corner : corners) {
    const double z =
        ground.height_m(flat.at(corner.x() * house.half_m.x(), corner.y() * house.half_m.y(), 0).head<2>());
    low = std::min(low, z);
    high = std::max(high, z);
  }
  const Style style = Style::random(random);
  const Placement floor = flat.moved(0, 0, high + 0.05);
  for (int side = 0; side < 4; ++side) {
    // Seen from outside a wall runs from its right corner to its left one, so that y is out of the house.
    const bool across = side % 2 == 1;
    const double half_width = across ? house.half_m.y() : house.half_m.x();
    const double half_depth = across ? house.half_m.x() : house.half_m.y();
    const Placement middle = floor.moved(0, 0, 0, side * std::numbers::pi / 2).moved(-half_width, half_depth, 0);
    const Face face{middle, 2 * half_width, house.height_m, high + 0.05 - low + kBelow_m};
    FacadeBuilder(mesh, random, style, face).build();
  }
  const bool pitched = random.chance(0.5) && house.height_m < kPitchedMax_m;
  add_roof(mesh, floor.moved(0, 0, house.height_m - 0.1), house.half_m, pitched, style.wall);
}

}  // namespace lxd::sim
