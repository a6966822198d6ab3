// SPDX-License-Identifier: Apache-2.0
// Shapes that the made worlds are put together from.
#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "tools/simulator/random.hpp"
#include "tools/simulator/world/surfaces.hpp"
#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

// Where a thing stands: the foot in the world, turned about z.
struct Placement {
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0;

  [[nodiscard]] Eigen::Vector3d at(double x, double y, double z) const;
  // The same turn, its foot moved by its own x, y, z; then turned further.
  [[nodiscard]] Placement moved(double x, double y, double z, double turn_rad = 0) const;
};

class MeshBuilder {
 public:
  explicit MeshBuilder(World& world) : world_(world) {}

  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, Surface surface);
  // Corners in turn.
  void quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d,
            Surface surface);
  // Corner i is at the high end of axis k where bit k of i is set.
  void hexahedron(const std::array<Eigen::Vector3d, 8>& corners, Surface surface);
  // Standing on the placement's foot, centred on it.
  void box(const Placement& at, const Eigen::Vector3d& size_m, Surface surface);
  // Between two opposite corners, along the axes.
  void block(const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m, Surface surface);
  // A cone's part with both ends closed.
  void cylinder(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double from_radius_m, double to_radius_m,
                int sides, Surface surface);
  // Steps going up along the placement's x from its foot (the middle of the first edge), solid down to it.
  void stairs(const Placement& at, double width_m, double run_m, double rise_m, int steps, Surface surface);
  // Leaf-sized triangles in a ball stretched to radii_m.
  void leaves(Random& random, const Eigen::Vector3d& centre_m, const Eigen::Vector3d& radii_m, int count,
              double size_m);

 private:
  std::uint32_t add(std::span<const Eigen::Vector3d> corners);
  void face(std::uint32_t a, std::uint32_t b, std::uint32_t c, Surface surface);

  World& world_;
};

}  // namespace lxd::sim
