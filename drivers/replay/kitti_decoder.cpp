// SPDX-License-Identifier: Apache-2.0
// See kitti_decoder.hpp.
#include "drivers/replay/kitti_decoder.hpp"

namespace lxd {

void KittiDecoder::decode(std::span<const float> floats, Sweep& sweep, PointCounts& counts) const {
  const auto turn_ns = static_cast<float>((sweep.end - sweep.begin).ns());
  for (std::size_t i = 0; i < floats.size(); i += 4) {
    const float* const in = &floats[i];
    if (!sound_point(in, counts)) continue;
    LidarPoint point{in[0], in[1], in[2], in[3], 0};
    if (times_ == PointTimes::from_azimuth) {
      point.offset_ns = static_cast<std::uint32_t>(turn_ns * kitti_turn_fraction(point.x_m, point.y_m));
    }
    if (!correction_.off()) correction_.apply(point.x_m, point.y_m, point.z_m);
    if (!sweep.push(point)) ++counts.above_capacity;
  }
}

LidarTraits hdl64_traits(Duration turn) {
  constexpr std::uint32_t kBeams = 64;
  constexpr std::uint32_t kColumns = 2083;  // 0.1728 degrees a firing at 10 Hz: HDL-64E S2 manual
  return {kBeams, kColumns, turn > Duration() ? 1 / turn.seconds() : 0};
}

}  // namespace lxd
