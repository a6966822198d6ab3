// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/things.hpp"

#include <cmath>
#include <numbers>

namespace lxd::sim {
namespace {

constexpr double kSunk_m = 0.4;  // how deep things go into the ground, for slopes

// A body of a car: a box whose roof is shorter and narrower than its floor.
void add_frustum(MeshBuilder& mesh, const Placement& at, const Eigen::Vector3d& size_m, double roof_rear,
                 double roof_front, double roof_narrow, Surface surface) {
  std::array<Eigen::Vector3d, 8> corners;
  for (unsigned i = 0; i < corners.size(); ++i) {
    const bool roof = (i & 4U) != 0;
    const double x = (i & 1U) != 0 ? (roof ? roof_front : 0.5) : (roof ? roof_rear : -0.5);
    const double y = ((i & 2U) != 0 ? 0.5 : -0.5) * (roof ? roof_narrow : 1);
    corners[i] = at.at(x * size_m.x(), y * size_m.y(), roof ? size_m.z() : 0);
  }
  mesh.hexahedron(corners, surface);
}

}  // namespace

TreeSize TreeSize::random(Random& random, double scale) {
  TreeSize size{};
  size.trunk_m = scale * random.uniform(2.6, 3.6);
  size.trunk_radius_m = scale * random.uniform(0.12, 0.22);
  size.crown_radius_m = scale * random.uniform(1.4, 2.4);
  size.crown_half_m = scale * random.uniform(1.3, 2.2);
  return size;
}

void add_tree(MeshBuilder& mesh, Random& random, const Placement& at, const TreeSize& size) {
  constexpr int kBranches = 5;
  const Eigen::Vector3d fork = at.at(0, 0, size.trunk_m);
  mesh.cylinder(at.at(0, 0, -kSunk_m), fork, size.trunk_radius_m, 0.7 * size.trunk_radius_m, 10, Surface::bark);
  for (int i = 0; i < kBranches; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random.uniform(0, 0.6)) / kBranches;
    const double reach = size.crown_radius_m * random.uniform(0.5, 0.8);
    const Eigen::Vector3d tip = at.at(reach * std::cos(angle), reach * std::sin(angle),
                                      size.trunk_m + size.crown_half_m * random.uniform(0.6, 1.5));
    mesh.cylinder(fork, tip, 0.4 * size.trunk_radius_m, 0.1 * size.trunk_radius_m, 5, Surface::bark);
  }
  const int count = static_cast<int>(75 * size.crown_radius_m * size.crown_half_m);
  mesh.leaves(random, at.at(0, 0, size.trunk_m + size.crown_half_m),
              {size.crown_radius_m, size.crown_radius_m, size.crown_half_m}, count, 0.32);
}

void add_lamp_post(MeshBuilder& mesh, Random& random, const Placement& at) {
  const double height = random.uniform(5.5, kLampPostHeight_m - 0.5);
  mesh.cylinder(at.at(0, 0, -kSunk_m), at.at(0, 0, height), 0.1, 0.06, 10, Surface::metal);
  mesh.box(at, {0.26, 0.26, 0.5}, Surface::concrete);
  mesh.box(at.moved(0.5, 0, height - 0.05), {1.1, 0.16, 0.12}, Surface::metal);
}

void add_sign(MeshBuilder& mesh, Random& random, const Placement& at) {
  const double height = random.uniform(2.3, 3.1);
  const double size = random.uniform(0.5, 0.8);
  mesh.cylinder(at.at(0, 0, -kSunk_m), at.at(0, 0, height), 0.035, 0.035, 8, Surface::metal);
  mesh.box(at.moved(0.05, 0, height - size), {0.02, size, size}, Surface::sign);
}

void add_parked_car(MeshBuilder& mesh, Random& random, const Placement& at) {
  static constexpr Surface kPaints[] = {Surface::paint_red, Surface::paint_blue, Surface::paint_white, Surface::metal,
                                        Surface::black};
  const Surface paint = kPaints[random.bits() % std::size(kPaints)];
  const double length = random.uniform(3.8, 2 * kCarHalfLength_m);
  const double width = random.uniform(1.65, 2 * kCarHalfWidth_m);
  const double height = random.uniform(1.4, 1.75);
  const double belt = 0.55 * height;
  constexpr double kClear_m = 0.2;
  add_frustum(mesh, at.moved(0, 0, kClear_m), {length, width, belt - kClear_m}, -0.485, 0.485, 0.96, paint);
  add_frustum(mesh, at.moved(-0.09 * length, 0, belt), {0.74 * length, 0.94 * width, height - belt}, -0.34, 0.33, 0.82,
              paint);
  // Panes a little outside the cabin.
  const Placement cabin = at.moved(-0.09 * length, 0, belt + 0.06);
  const double pane = height - belt - 0.16;
  add_frustum(mesh, cabin, {0.6 * length, 0.95 * width, pane}, -0.38, 0.36, 0.88, Surface::glass);
  add_frustum(mesh, cabin, {0.735 * length, 0.7 * width, pane}, -0.38, 0.375, 0.86, Surface::glass);
  constexpr double kWheel_m = 0.31;
  for (const double end : {-0.31, 0.31})
    for (const double side : {-0.5, 0.5})
      mesh.cylinder(at.at(end * length, side * (width - 0.4), kWheel_m), at.at(end * length, side * width, kWheel_m),
                    kWheel_m, kWheel_m, 12, Surface::black);
}

void add_hedge(MeshBuilder& mesh, Random& random, const Placement& at, double length_m, double width_m) {
  const double height = random.uniform(0.8, 1.7);
  mesh.box(at.moved(0, 0, -kSunk_m), {length_m, width_m, height + kSunk_m}, Surface::foliage);
  const int clumps = static_cast<int>(length_m / 0.4);
  for (int i = 0; i < clumps; ++i)
    mesh.leaves(random, at.at(length_m * ((i + 0.5) / clumps - 0.5), 0, height / 2),
                {0.3, 0.55 * width_m, 0.55 * height}, 24, 0.15);
}

void add_wall(MeshBuilder& mesh, const Placement& at, double length_m, double height_m, Surface surface) {
  mesh.box(at.moved(0, 0, -2 * kSunk_m), {length_m, 0.25, height_m + 2 * kSunk_m}, surface);
  mesh.box(at.moved(0, 0, height_m), {length_m, 0.33, 0.06}, Surface::concrete);
}

void add_bench(MeshBuilder& mesh, const Placement& at) {
  mesh.box(at.moved(0, 0, 0.4), {1.6, 0.45, 0.06}, Surface::wood);
  mesh.box(at.moved(0, 0.22, 0.55), {1.6, 0.05, 0.35}, Surface::wood);
  for (const double side : {-0.6, 0.6})
    mesh.box(at.moved(side, 0, -kSunk_m), {0.1, 0.4, 0.4 + kSunk_m}, Surface::concrete);
}

void add_kerb(MeshBuilder& mesh, const Ground& ground, const Line& line, bool closed, double width_m, double height_m,
              Surface surface) {
  const std::size_t n = line.size();
  const auto along = [&](std::size_t i) -> Eigen::Vector2d {
    const std::size_t before = i > 0 ? i - 1 : (closed ? n - 1 : i);
    const std::size_t after = i + 1 < n ? i + 1 : (closed ? 0 : i);
    return (line[after] - line[before]).normalized();
  };
  for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
    const LinePoint from{line[i], along(i)};
    const LinePoint to{line[(i + 1) % n], along((i + 1) % n)};
    std::array<Eigen::Vector3d, 8> corners;
    for (unsigned k = 0; k < corners.size(); ++k) {
      const LinePoint& end = (k & 1U) != 0 ? to : from;
      corners[k] = ground.on(end.left(((k & 2U) != 0 ? 0.5 : -0.5) * width_m), (k & 4U) != 0 ? height_m : -kSunk_m);
    }
    mesh.hexahedron(corners, surface);
  }
}

}  // namespace lxd::sim
