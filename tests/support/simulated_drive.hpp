// SPDX-License-Identifier: Apache-2.0
// A small world and a drive in it, for sensors that need a context: a circle on flat ground, with banking and a change
// of speed, so that no term of a velocity is zero.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "rt/so3.hpp"
#include "tools/simulator/context.hpp"

namespace lxd::test {

inline void add_quad(sim::World& world, const Eigen::Vector3f& corner, const Eigen::Vector3f& a,
                     const Eigen::Vector3f& b, std::uint16_t material = 0) {
  const auto first = static_cast<std::uint32_t>(world.vertices.size());
  world.vertices.insert(world.vertices.end(), {corner, corner + a, corner + a + b, corner + b});
  world.faces.push_back({first, first + 1, first + 2});
  world.faces.push_back({first, first + 2, first + 3});
  world.face_material.insert(world.face_material.end(), {material, material});
}

inline sim::World open_ground() {
  sim::World world;
  world.materials.push_back({.name = "ground"});
  world.materials.push_back({.name = "pane", .glass = true});
  add_quad(world, {-200, -200, -5}, {400, 0, 0}, {0, 400, 0});
  return world;
}

// Counter-clockwise around the origin; x forward. 20 m from the centre, some 3 m/s.
inline sim::Trajectory circle(double duration_s) {
  constexpr double kStep_s = 0.1, kRadius_m = 20;
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Quaterniond> rotations;
  for (double t = -1; t < duration_s + 2; t += kStep_s) {
    const double angle = 0.15 * t + 0.1 * std::sin(0.5 * t);
    positions.emplace_back(kRadius_m * std::cos(angle), kRadius_m * std::sin(angle), 0.2 * std::sin(0.7 * t));
    const Eigen::Vector3d lean(0.05 * std::sin(0.9 * t), 0.03 * std::cos(0.6 * t), 0);
    rotations.emplace_back(Eigen::AngleAxisd(angle + std::numbers::pi / 2, Eigen::Vector3d::UnitZ()) *
                           Eigen::Quaterniond(Exp(lean)));
  }
  return {-1, kStep_s, positions, rotations};
}

// Everything that a sensor is given, and what it is a part of.
struct Drive {
  explicit Drive(double seconds, sim::World ground = open_ground(), std::vector<sim::Fault> plan = {},
                 std::uint64_t seed = 1)
      : world(std::move(ground)),
        scene(world),
        motion(circle(seconds)),
        faults(std::move(plan)),
        context{scene, motion, faults, seed, RigTime::from_ns(1'750'000'000'000'000'000), seconds} {}
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;

  [[nodiscard]] double seconds_of(RigTime t) const { return (t - context.start).seconds(); }

  sim::World world;
  sim::Scene scene;
  sim::Trajectory motion;
  sim::FaultPlan faults;
  sim::Context context;
};

// Whether a program is there; a witness that is not is none.
inline bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;
}

}  // namespace lxd::test
