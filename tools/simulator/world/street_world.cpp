// SPDX-License-Identifier: Apache-2.0
// A street around a block, more than a kilometre of it, houses on both sides, gentle relief.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/simulator/world/planting.hpp"
#include "tools/simulator/world/route_shape.hpp"
#include "tools/simulator/world/things.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim {
namespace {

constexpr double kLane_m = 1.75;        // from the centre line to a lane's middle
constexpr double kCarriageway_m = 3.6;  // half of it
constexpr double kParking_m = 4.75;     // from the centre line to the middle of a parked car
constexpr double kKerb_m = 5.9;
constexpr double kPavementEnd_m = 9;
constexpr double kStreetQuarter_rad = std::numbers::pi / 2;

// Stretches of the street without houses at the kerb: where side streets leave.
class SideStreets {
 public:
  SideStreets(Random& random, double length_m) {
    for (double s = random.uniform(30, 70); s < length_m - 30; s += random.uniform(70, 130)) at_m_.push_back(s);
  }
  [[nodiscard]] bool opens_at(double s_m, double half_m) const {
    constexpr double kHalf_m = 5;
    for (const double at : at_m_)
      if (std::abs(s_m - at) < kHalf_m + half_m) return true;
    return false;
  }

 private:
  std::vector<double> at_m_;
};

class StreetBuilder {
 public:
  StreetBuilder(Site& site, const Ground& ground, const Line& centre)
      : site_(site),
        planting_(site, ground),
        ground_(ground),
        centre_(centre),
        length_m_(length_m(centre, true)),
        side_streets_{SideStreets(site.random, length_m_), SideStreets(site.random, length_m_)} {}

  void build() {
    for (const double side : {1.0, -1.0}) {
      add_kerbs(side);
      add_houses(side);
      park_cars(side);
      add_row_of_trees(side);
    }
    add_background();
    add_traffic();
  }

 private:
  [[nodiscard]] LinePoint at(double s_m) const { return point_at(centre_, s_m, true); }
  // side: +1 is to the left, which is inside the block.
  [[nodiscard]] const SideStreets& side_streets(double side) const { return side_streets_[side > 0 ? 0 : 1]; }

  void add_kerbs(double side) {
    constexpr double kStep_m = 2;
    Line part;
    const auto finish = [&] {
      if (part.size() > 1) {
        add_kerb(site_.mesh, ground_, part, false, 0.25, 0.13, Surface::concrete);
      }
      part.clear();
    };
    for (double s = 0; s <= length_m_; s += kStep_m) {
      if (side_streets(side).opens_at(s, 0)) {
        finish();
      } else {
        part.push_back(at(s).left(side * kKerb_m));
      }
    }
    finish();
  }

  void add_houses(double side) {
    Random& random = site_.random;
    double setback = kPavementEnd_m + 0.5;
    for (double s = 0; s < length_m_;) {
      const double width = random.uniform(8, 20);
      const double depth = random.uniform(8, 12);
      const double height = random.uniform(5, 15);
      if (random.chance(0.4)) setback = kPavementEnd_m + random.uniform(0.3, 3.5);
      const LinePoint middle = at(s + width / 2);
      if (side_streets(side).opens_at(s + width / 2, width / 2)) {
        s += 3;
      } else if (random.chance(0.12)) {
        garden(middle, side, setback, width);
        s += width + 1;
      } else if (planting_.house(
                     {middle.left(side * (setback + depth / 2)), {width / 2, depth / 2}, middle.yaw_rad(), height},
                     -0.05)) {
        s += width + (random.chance(0.35) ? random.uniform(1, 6) : 0.1);
      } else {
        s += 4;
      }
    }
  }

  void garden(const LinePoint& middle, double side, double setback, double width) {
    Random& random = site_.random;
    const Eigen::Vector2d front = middle.left(side * setback);
    if (random.chance(0.5)) {
      planting_.hedge(front, middle.yaw_rad(), width);
    } else {
      planting_.wall(front, middle.yaw_rad(), width, random.uniform(1.2, 2.2), Surface::brick);
    }
    planting_.tree(middle.left(side * (setback + 5)), random.uniform(0.9, 1.4));
  }

  void park_cars(double side) {
    Random& random = site_.random;
    bool parking = true;
    for (double s = 4; s < length_m_; s += random.uniform(5.2, 6.8)) {
      if (random.chance(0.2)) parking = !parking;
      if (!parking || side_streets(side).opens_at(s, 4)) continue;
      const LinePoint here = at(s);
      const double turn = random.uniform(-0.03, 0.03) + (side > 0 ? std::numbers::pi : 0);
      planting_.car(here.left(side * (kParking_m + random.uniform(0, 0.15))), here.yaw_rad() + turn);
    }
  }

  void add_row_of_trees(double side) {
    Random& random = site_.random;
    for (double s = 3; s < length_m_; s += random.uniform(7, 15)) {
      if (side_streets(side).opens_at(s, 1)) continue;
      const LinePoint here = at(s);
      const Eigen::Vector2d spot = here.left(side * (kKerb_m + random.uniform(0.5, 0.8)));
      const double chosen = random.uniform();
      if (chosen < 0.4) {
        planting_.tree(spot, random.uniform(0.75, 1.0));
      } else if (chosen < 0.7) {
        planting_.lamp_post(spot, here.yaw_rad() - side * kStreetQuarter_rad);
      } else {
        planting_.sign(spot, here.yaw_rad() + std::numbers::pi);
      }
    }
  }

  // What is seen through the side streets.
  void add_background() {
    Random& random = site_.random;
    for (int i = 0; i < 150; ++i) {
      const LinePoint here = at(random.uniform(0, length_m_));
      const double off = random.uniform(26, 50) * (random.chance(0.5) ? 1 : -1);
      const double half_x = random.uniform(7, 15);
      const double half_y = random.uniform(6, 9);
      const double height = random.uniform(7, 17);
      const double yaw = here.yaw_rad() + random.uniform(-0.2, 0.2);
      planting_.house({here.left(off), {half_x, half_y}, yaw, height}, 1);
      planting_.tree(here.left(0.6 * off), random.uniform(0.9, 1.5));
    }
  }

  void add_traffic() {
    Random& random = site_.random;
    constexpr int kCars = 7;
    constexpr int kPeople = 14;
    Line oncoming = beside(centre_, kLane_m);
    std::ranges::reverse(oncoming);
    oncoming.push_back(oncoming.front());
    const double speed = random.uniform(6, 9);  // one for all: they would drive through each other
    for (int i = 0; i < kCars; ++i) {
      const double start = length_m_ * (i + random.uniform(0, 0.8)) / kCars;
      site_.add_driver(ground_.on(oncoming), speed, start);
    }
    for (int i = 0; i < kPeople; ++i) {
      const double from = random.uniform(0, length_m_);
      const double side = random.chance(0.5) ? 1 : -1;
      std::vector<Eigen::Vector3d> way;
      for (double s = from; s < from + 30; s += 2) way.push_back(ground_.on(at(s).left(side * (kPavementEnd_m - 0.9))));
      site_.add_walker(std::move(way), random.uniform(0, 30));
    }
  }

  Site& site_;
  Planting planting_;
  const Ground& ground_;
  const Line& centre_;
  double length_m_;
  std::array<SideStreets, 2> side_streets_;
};

void add_routes(Site& site, const Ground& ground, const Line& centre) {
  site.add_route({"drive", ground.on(beside(centre, -kLane_m)), true, 1.2}, {1.7, 0.5, 3.2});
  site.keep_clear(ground.on(beside(centre, kLane_m)), true, {1.7, 0.5, 3.2});
  site.add_route({"walk", ground.on(beside(centre, -(kPavementEnd_m - 1))), true, 0.7}, {0.95, 0.5, 2.4});
}

}  // namespace

World make_street(std::uint64_t seed) {
  constexpr double kCornerRadius_m = 16;
  constexpr double kMargin_m = 75;
  Site site("street", seed);
  const Eigen::Vector2d half{site.random.uniform(170, 190), site.random.uniform(100, 115)};
  // Anticlockwise, so that who keeps to the right drives on the outside. The sides are bent a little.
  const double bend = site.random.uniform(6, 14);
  const Line corners{{-half.x(), -half.y()}, {0, -half.y() - bend}, {half.x(), -half.y()}, {half.x() + bend, 0},
                     {half.x(), half.y()},   {0, half.y() - bend},  {-half.x(), half.y()}};
  const Line centre = rounded(corners, kCornerRadius_m, 2, true);
  const Relief relief(site.random, 5, 420);
  const Eigen::Vector2d reach = half + Eigen::Vector2d::Constant(kMargin_m);
  const Ground ground(-reach, reach, 3, relief);
  ground.add_to(site.mesh, [&](const Eigen::Vector2d& at) {
    double off = 1e9;
    for (const Eigen::Vector2d& point : centre) off = std::min(off, (point - at).norm());
    if (off < kKerb_m + 0.5) return Surface::asphalt;
    return off < kPavementEnd_m + 1 ? Surface::paving : Surface::grass;
  });
  add_routes(site, ground, centre);
  StreetBuilder(site, ground, centre).build();
  return std::move(site.world);
}

}  // namespace lxd::sim
