// SPDX-License-Identifier: Apache-2.0
// What a scenario says of the rig's motion.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "board/yaml_section.hpp"

namespace lxd::sim {

struct MotionConfig {
  std::string carrier = "handheld";  // of carrier_names()
  double rest_s = 2;                 // at rest exactly, before the motion is eased in
  bool start_moving = false;         // in motion from the first instant on; no rest

  // Generated motion.
  std::string route;     // of the world; empty: the first of the carrier's kind
  double speed_mps = 0;  // along straight ways; 0: the carrier's own
  double height_m = 0;   // of the body above the route; 0: the carrier's own
  double vigour = 1;     // of gait, shake, vibration, wind: 0 is a trolley's run

  // Recorded motion ("path").
  std::filesystem::path file;
  std::string format = "auto";  // of path_formats()
  double file_start_s = 2;      // which instant of the file is t = 0
  bool level = false;           // turn the path so that the plane through it is level
  double cutoff_hz = 0;         // of the smoothing; 0: the format's own
  // x y z in m, yaw in rad: where in the world the body is at t = 0. Nothing: the file's own coordinates.
  std::optional<std::array<double, 4>> origin;
};

// handheld, uav, legged, wheeled, car, path.
std::span<const std::string_view> carrier_names();
// auto, tum, ntu_viral, oxts.
std::span<const std::string_view> path_formats();

// Keys: carrier, start (rest, moving), rest_s; route, speed_mps, height_m, vigour; file, format, file_start_s, level
// (yes, no), cutoff_hz, origin ([x, y, z, yaw_deg]).
void read_keys(YamlSection& section, MotionConfig& config);

}  // namespace lxd::sim
