// SPDX-License-Identifier: Apache-2.0
#include "board/rig.hpp"

namespace lxd {

void complete(Rig& rig, const LidarTraits& traits) {
  if (rig.lidar0.beams == 0) rig.lidar0.beams = traits.beams;
  if (rig.lidar0.columns == 0) rig.lidar0.columns = traits.columns;
}

Rig default_rig(const LidarTraits& traits) {
  Rig rig;
  if (traits.rate_hz > 0) rig.lidar0.rate_hz = traits.rate_hz;
  complete(rig, traits);
  return rig;
}

}  // namespace lxd
