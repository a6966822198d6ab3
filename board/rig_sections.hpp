// SPDX-License-Identifier: Apache-2.0
// The keys of each sensor in a rig file, with their ranges. Extrinsics are read by the rig's loader, for they depend on
// the reference.
#pragma once

#include "board/rig.hpp"
#include "board/yaml_section.hpp"

namespace lxd {

// By how much a sensor is stamped later than the LiDAR.
inline constexpr ValueRange kDelay{-0.05, 0.05, "s", "is it in milliseconds?"};
inline constexpr ValueRange kDelaySigma{0, 0.02, "s", "is it in milliseconds?"};

void read_keys(YamlSection& section, ImuRig& imu);
void read_keys(YamlSection& section, LidarRig& lidar);
void read_keys(YamlSection& section, CameraRig& camera);
void read_keys(YamlSection& section, WheelRig& wheel);
void read_keys(YamlSection& section, GnssRig& gnss);

}  // namespace lxd
