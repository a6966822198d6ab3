// SPDX-License-Identifier: Apache-2.0
// A small world and a lively motion for simulated LiDARs, and the distance of a point from the world's surface.
#pragma once

#include <algorithm>
#include <vector>

#include "tools/simulator/context.hpp"

namespace lxd::test {

// Appends a parallelogram: corner, corner + u, corner + u + v, corner + v.
inline void add_parallelogram(sim::World& world, const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
                              const Eigen::Vector3f& v, std::uint16_t material) {
  const auto first = static_cast<std::uint32_t>(world.vertices.size());
  for (const Eigen::Vector3f& p :
       {corner, Eigen::Vector3f(corner + u), Eigen::Vector3f(corner + u + v), Eigen::Vector3f(corner + v)}) {
    world.vertices.push_back(p);
  }
  world.faces.push_back({first, first + 1, first + 2});
  world.faces.push_back({first, first + 2, first + 3});
  world.face_material.insert(world.face_material.end(), 2, material);
}

// The inner faces of a hall of 24 x 16 x 6 m around the origin, with a slanted board in it. Material 1 is glass.
inline sim::World hall(float albedo = 0.5F) {
  sim::World world;
  sim::Material wall;
  wall.albedo = albedo;
  wall.contrast = 0;
  sim::Material glass = wall;
  glass.glass = true;
  world.materials = {wall, glass};
  using V = Eigen::Vector3f;
  const V low(-12, -8, -2), x(24, 0, 0), y(0, 16, 0), z(0, 0, 6);
  add_parallelogram(world, low, x, y, 0);
  add_parallelogram(world, low + z, x, y, 0);
  add_parallelogram(world, low, x, z, 0);
  add_parallelogram(world, low + y, x, z, 0);
  add_parallelogram(world, low, y, z, 0);
  add_parallelogram(world, low + x, y, z, 0);
  add_parallelogram(world, V(4, -2, -2), V(1, 3, 0), V(0.5F, 0, 3), 0);
  return world;
}

// Turning about every axis while moving, within 2 m of the origin.
inline sim::Trajectory lively_motion(double duration_s) {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Quaterniond> rotations;
  constexpr double kStep_s = 0.1;
  for (double t = -1; t < duration_s + 1; t += kStep_s) {
    positions.emplace_back(std::sin(2.1 * t), 0.8 * std::cos(1.7 * t), 0.4 * std::sin(2.9 * t));
    rotations.emplace_back(Eigen::AngleAxisd(1.2 * t, Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(0.3 * std::sin(3 * t), Eigen::Vector3d::UnitX()) *
                           Eigen::AngleAxisd(0.2 * std::cos(2 * t), Eigen::Vector3d::UnitY()));
  }
  return {-1, kStep_s, positions, rotations};
}

inline sim::Trajectory standing() { return {0, 1, {Eigen::Vector3d::Zero()}, {Eigen::Quaterniond::Identity()}}; }

// Everything a Context refers to, alive.
struct LidarRig {
  explicit LidarRig(double duration, sim::FaultPlan plan = {}, sim::World its_world = hall(), bool moves = true)
      : world(std::move(its_world)),
        scene(world),
        motion(moves ? lively_motion(duration) : standing()),
        faults(std::move(plan)),
        context{scene, motion, faults, 7, RigTime::from_ns(1'767'268'800 * kNanosPerSecond), duration} {
    T_body_sensor.R =
        (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()))
            .toRotationMatrix();
    T_body_sensor.p = Eigen::Vector3d(0.1, -0.2, 0.3);
  }

  // From a sensor's frame at a time since the start.
  [[nodiscard]] Eigen::Vector3d to_world(double t_s, const Eigen::Vector3d& p_sensor) const {
    return motion.pose(t_s) * T_body_sensor * p_sensor;
  }

  sim::World world;
  sim::Scene scene;
  sim::Trajectory motion;
  sim::FaultPlan faults;
  sim::Context context;
  Pose T_body_sensor;
};

// To the triangle a, b, c (Ericson, Real-Time Collision Detection, 5.1.5, by barycentric clamping on the edges).
inline double triangle_distance_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c) {
  const Eigen::Vector3d n = (b - a).cross(c - a).normalized();
  const Eigen::Vector3d q = p - n * n.dot(p - a);
  const auto inside = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    return n.dot((v - u).cross(q - u)) >= 0;
  };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return (p - q).norm();
  const auto to_edge = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    const double part = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
    return (p - u - part * (v - u)).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

inline double surface_distance_m(const sim::World& world, const Eigen::Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& face : world.faces) {
    const auto corner = [&](int i) {
      return Eigen::Vector3d(world.vertices[face[static_cast<std::size_t>(i)]].cast<double>());
    };
    nearest = std::min(nearest, triangle_distance_m(p, corner(0), corner(1), corner(2)));
  }
  return nearest;
}

}  // namespace lxd::test
