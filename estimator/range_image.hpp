// SPDX-License-Identifier: Apache-2.0
// A sweep as a low-resolution spherical image of inverse ranges: 1/r of a plane is linear in the viewing direction, so
// that what lies between two beams is interpolated well. Columns are azimuths, rows elevations, in the LiDAR's frame;
// how many beams the LiDAR has and where they point shows in the sweep itself.
#pragma once

#include <cstdint>
#include <numbers>
#include <span>

#include <Eigen/Core>

#include "rt/arena.hpp"

namespace lxd {

// Direction and distance as the image counts them: azimuth in (-pi, pi] about z from x, elevation above the xy plane.
struct Spherical {
  float azimuth_rad, elevation_rad, range_m;
};
Spherical to_spherical(const Eigen::Vector3f& p);  // angles to 1e-5 rad

class RangeImage {
 public:
  static constexpr int kColumns = 240, kRows = 120;  // 1.5 degrees each
  static constexpr float kStep_rad = static_cast<float>(std::numbers::pi) / kRows;

  explicit RangeImage(Arena& arena);

  void clear();
  void add(const Eigen::Vector3f& p);  // in the LiDAR's frame, m; not the origin itself
  void finish();                       // after the last add: means, and the rows between the beams
  [[nodiscard]] bool empty() const { return row_end_ <= row_begin_; }

  struct Look {
    float inverse_range, d_azimuth, d_elevation;  // 1/m, and its derivatives, 1/(m rad)
  };
  // Bilinear; false where the sweep saw nothing.
  [[nodiscard]] bool look(float azimuth_rad, float elevation_rad, Look& out) const;

 private:
  struct Bin {
    float inverse_range = 0, elevation = 0;  // sums; the elevation counted in rows
    std::uint32_t count = 0;
  };
  void fill_column(int column);

  std::span<Bin> bins_;              // a column's rows are neighbours
  std::span<float> inverse_ranges_;  // 0: nothing seen
  int row_begin_ = 0, row_end_ = 0;  // rows in use
};

}  // namespace lxd
