// SPDX-License-Identifier: Apache-2.0
// What a LiDAR makes of the surface that its beam meets: how far it says it is, how bright, or nothing at all.
#pragma once

#include "board/yaml_section.hpp"
#include "tools/simulator/lidar/lidar_faults.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/world/scene.hpp"

namespace lxd::sim {

struct ReturnConfig {
  double range_min_m = 0.5, range_max_m = 150;
  double range_sigma_m = 0.01;    // of a bright surface met head on; 0: ranges are exact
  double detection_range_m = 60;  // where nine of ten shots at a surface of albedo 0.1 return; 0: every shot does
  double mixed_part = 0.25;       // of the shots beside a depth edge: a range between the two surfaces
  double outlier_part = 2e-5;     // of all shots: some range, with nothing there
  double glass_part = 1;          // of the shots at glass: nothing returns
};

// 0, or nothing, of every effect but the range limits and the glass.
ReturnConfig without_errors(ReturnConfig config);
void read_keys(YamlSection& section, ReturnConfig& config);

struct Return {
  float range_m = 0;     // from the beam's origin; 0: nothing came back
  float brightness = 0;  // albedo times the cosine of incidence, 0 .. 1
  float albedo = 0;
  bool trailing = false;  // between two surfaces
  bool outlier = false;   // nothing was there

  [[nodiscard]] bool found() const { return range_m > 0; }
};

// Where a shot went, for the look at its neighbour.
struct Shot {
  Ray ray;
  Hit hit;
};

// The fault kOneVoxel: all that there is to see is a plate before the sensor, beyond any blind zone, at x = kPlate_m
// and not far from the axis. What a shot into `direction` (unit, sensor's frame) has of it.
inline constexpr double kPlate_m = 2, kPlateHalfSide_m = 0.25;
Return plate_return(const Eigen::Vector3d& direction);

class ReturnModel {
 public:
  // Keeps a reference to the world.
  ReturnModel(const ReturnConfig& config, const World& world) : config_(config), world_(world) {}

  // `neighbour`: the shot beside it in the scan, for depth edges; null: none. Precondition: not kOneVoxel, which is a
  // matter of the sensor's frame.
  Return measure(const Shot& shot, const Shot* neighbour, ShotFault fault, Random& random) const;

 private:
  [[nodiscard]] Return measure_sound(const Shot& shot, const Shot* neighbour, Random& random) const;
  [[nodiscard]] bool passes_glass(const Hit& hit, Random& random) const;
  [[nodiscard]] double signal(double range_m, double brightness) const;
  [[nodiscard]] bool detected(double signal, Random& random) const;
  // True: `range_m` lies between the surfaces, and may have come to nothing (0).
  bool mix(const Shot& shot, const Shot& neighbour, Random& random, double& range_m) const;
  [[nodiscard]] double noise_m(double signal, double cos_incidence, Random& random) const;

  ReturnConfig config_;
  const World& world_;
};

}  // namespace lxd::sim
