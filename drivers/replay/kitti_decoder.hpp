// SPDX-License-Identifier: Apache-2.0
// KITTI's scan files: float32 x, y, z (m), reflectance (0..1), no time.
#pragma once

#include "drivers/replay/kitti_geometry.hpp"
#include "drivers/replay/scan_source.hpp"

namespace lxd {

enum class PointTimes { all_at_begin, from_azimuth };

class KittiDecoder final : public ScanDecoder {
 public:
  KittiDecoder(PointTimes times, double vertical_angle_correction_rad)
      : times_(times), correction_(vertical_angle_correction_rad) {}

  [[nodiscard]] std::size_t floats_per_point() const override { return 4; }
  void decode(std::span<const float> floats, Sweep& sweep, PointCounts& counts) const override;

 private:
  PointTimes times_;
  ElevationCorrection correction_;
};

// The HDL-64E's, with the rate that the recording's stamps show (0: not known).
LidarTraits hdl64_traits(Duration turn);

}  // namespace lxd
