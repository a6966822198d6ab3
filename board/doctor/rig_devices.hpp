// SPDX-License-Identifier: Apache-2.0
// Whether the devices that a rig file names are there and may be used. None is opened: a rig that runs is not
// disturbed.
#pragma once

#include <filesystem>
#include <vector>

#include "board/doctor/diagnosis.hpp"
#include "board/rig.hpp"

namespace lxd {

// root: "/" for this machine. A finding each for serial lines, the CAN interface, the camera, the pulse and the
// triggers that the rig names; network sensors are none of this.
std::vector<Finding> diagnose_devices(const Rig& rig, const std::filesystem::path& root);

}  // namespace lxd
