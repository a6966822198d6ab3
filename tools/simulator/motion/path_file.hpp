// SPDX-License-Identifier: Apache-2.0
// Paths that real carriers took, read from files and followed with a smooth curve.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "rt/result.hpp"
#include "tools/simulator/motion/motion_config.hpp"
#include "tools/simulator/motion/path_fit.hpp"

namespace lxd::sim {

struct RecordedPath {
  std::string_view format;          // of path_formats(), never auto
  std::vector<PathSample> samples;  // t = 0 at the first; strictly increasing
  bool oriented = true;             // false: positions only
};

// Times of TUM and NTU-VIRAL files may be of any epoch. OXTS positions are east, north, up of the first.
// Error: file:line, found and wanted: the number of columns, a number, finite, later than the line before, a unit
// quaternion, latitude and longitude on the Earth; a format that is not known; too few poses.
Result<RecordedPath> load_path(const std::filesystem::path& file, std::string_view format);

// Turned about its first position so that the plane through all positions is level.
void level(RecordedPath& path);

// The motion of a scenario whose carrier is a path; covers [-1 s, duration + 1 s].
// Error: as load_path; a path that is over before the motion is.
Result<Trajectory> recorded_motion(const MotionConfig& config, double duration_s);

}  // namespace lxd::sim
