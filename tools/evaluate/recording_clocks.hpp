// SPDX-License-Identifier: Apache-2.0
// How well the clock model maps the sensors' stamps of a simulated recording, against its clocks.csv.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "board/rig.hpp"
#include "rt/result.hpp"
#include "tools/evaluate/clock_errors.hpp"

namespace lxd {

// lidar0 by its sweeps, the IMU by its samples where it sends its own time. The model's first seconds, in which it
// learns, are left out. Empty without clocks.csv. Error: a file that cannot be read.
Result<std::map<std::string, ClockErrors>> recording_clock_errors(const std::filesystem::path& recording,
                                                                  const Rig& rig);

}  // namespace lxd
