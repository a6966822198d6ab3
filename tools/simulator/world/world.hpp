// SPDX-License-Identifier: Apache-2.0
// A world: triangles with materials, what moves in it, and the ways that a carrier can go. World frame: z up, metres.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lxd::sim {

struct Material {
  std::string name;
  float albedo = 0.4F;                   // of the diffuse surface at the LiDAR's wavelength and in the image, 0 .. 1
  float contrast = 0.3F;                 // how far the texture moves the albedo, 0 .. 1
  float texel_m = 0.1F;                  // size of the texture's largest features
  std::array<float, 3> colour{1, 1, 1};  // times albedo: what the camera sees, linear RGB
  bool glass = false;                    // returns nothing to a LiDAR; the camera sees it as a dark surface
};

// People and cars: in no map. An upright box (half extents; x along the way) whose centre follows the way at constant
// speed: round and round when the way ends where it began, else forth and back.
struct Mover {
  Eigen::Vector3f half_m = Eigen::Vector3f::Ones();
  std::uint16_t material = 0;
  std::vector<Eigen::Vector3f> way_m;  // at least two points; the centre's path
  float speed_mps = 1;
  float start_m = 0;  // along the way, at t = 0
};

// A way on the floor that stays clear of every surface by at least clearance_m to either side.
struct Route {
  std::string name;                    // "walk", "drive", "fly"
  std::vector<Eigen::Vector3d> way_m;  // on the floor (walk, drive), or the flown height (fly)
  bool closed = false;
  double clearance_m = 0.5;
};

struct World {
  std::string name;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
  std::vector<std::uint16_t> face_material;  // as faces; into materials
  std::vector<Material> materials;
  std::vector<Mover> movers;
  std::vector<Route> routes;
};

}  // namespace lxd::sim
