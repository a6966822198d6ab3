// SPDX-License-Identifier: Apache-2.0
// The configuration in force: defaults, then what the rig file says of its sensors, then its settings, then the command
// line's. Later ones win.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "board/rig.hpp"
#include "board/sensor_set.hpp"
#include "board/settings.hpp"
#include "board/star.hpp"
#include "rt/result.hpp"

namespace lxd {

struct Configuration {
  Rig rig;
  bool has_rig_file = false;
  SensorSet sensors;  // in use
  Settings settings;
  std::vector<std::string> remarks;  // what was left out and taken for granted
};

// `rig_file` comes before a rig.yaml in the recording's folder; with neither, the rig is the LiDAR alone and completed
// by the recording once it is open (complete_by). Error: all problems of the rig file, or all of `choices`.
Result<Configuration> configure(const std::filesystem::path& recording,
                                const std::optional<std::filesystem::path>& rig_file,
                                std::span<const std::string> choices);

void complete_by(Configuration& configuration, const LidarTraits& traits);

// For runs that must keep pace with their sensors: unless a budget is set, a sweep may take kSweepShare of the time to
// the next one.
void keep_pace(Configuration& configuration);

}  // namespace lxd
