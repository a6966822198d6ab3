// SPDX-License-Identifier: Apache-2.0
// What each sensor of a rig recording delivered, as the panels of sensors.png.
#pragma once

#include <filesystem>
#include <vector>

#include "board/rig.hpp"
#include "rt/result.hpp"
#include "tools/evaluate/plots/sensor_plots.hpp"

namespace lxd {

// A panel or more for each sensor that the rig names and the recording holds; time zero is the first sweep's begin.
// Reads the whole recording through the parsers of the live rig. Error: a log or capture that cannot be read.
Result<std::vector<SensorPanel>> recording_panels(const std::filesystem::path& recording, const Rig& rig);

}  // namespace lxd
