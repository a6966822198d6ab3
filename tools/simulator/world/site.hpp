// SPDX-License-Identifier: Apache-2.0
// A world in the making: what may still be built where, so that things do not stand in each other or in a route.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "tools/simulator/random.hpp"
#include "tools/simulator/world/mesh_builder.hpp"
#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

// A turned rectangle on the plane and the heights that the thing fills.
struct Footprint {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_m = Eigen::Vector2d::Ones();
  double yaw_rad = 0;
  double low_m = -1e3;
  double high_m = 1e3;

  [[nodiscard]] double distance_m(const Eigen::Vector2d& point) const;  // 0 within
  [[nodiscard]] bool meets(const Footprint& other, double gap_m) const;
};

class Site {
 public:
  Site(std::string_view name, std::uint64_t seed);
  Site(const Site&) = delete;  // the builder holds the world
  Site& operator=(const Site&) = delete;

  World world;
  MeshBuilder mesh;
  Random random;

  // How much of a way's surroundings stays free of what take() is asked for later: to either side, and from below_m
  // under to above_m over it.
  struct Room {
    double beside_m = 1, below_m = 0.5, above_m = 2.4;
  };
  void keep_clear(std::span<const Eigen::Vector3d> way_m, bool closed, const Room& room);
  // Adds the route to the world and keeps it clear.
  void add_route(Route route, const Room& room);
  // Nothing stands there and no route passes. take() also occupies it.
  [[nodiscard]] bool is_free(const Footprint& wanted, double gap_m) const;
  [[nodiscard]] bool is_off_routes(const Footprint& wanted) const;
  bool take(const Footprint& wanted, double gap_m);
  void occupy(const Footprint& print) { taken_.push_back(print); }

  // A person or car that goes along the way (feet or wheels on it); heights as given.
  void add_walker(std::vector<Eigen::Vector3d> way_m, double start_m);
  void add_driver(std::vector<Eigen::Vector3d> way_m, double speed_mps, double start_m);

 private:
  struct KeepClear {
    std::vector<Eigen::Vector3d> points_m;  // close together
    Eigen::Vector2d low_m, high_m;
    Room room;
  };
  [[nodiscard]] static bool blocks(const Footprint& wanted, const KeepClear& keep);

  std::vector<Footprint> taken_;
  std::vector<KeepClear> keep_clear_;
};

}  // namespace lxd::sim
