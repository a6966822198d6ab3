// SPDX-License-Identifier: Apache-2.0
// Every number that a user may set: its dotted key, unit, range and meaning in one table, from which `--set`, the
// rig file's `settings`, the run folder's rig.yaml and the parameter reference are made.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "backend/graph/config.hpp"
#include "estimator/config.hpp"
#include "mapping/config.hpp"
#include "rt/result.hpp"

namespace lxd {

struct ReplaySettings {
  // KITTI's Velodyne points are bent by a wrong vertical angle in its calibration; 0.205 degrees is what IMLS-SLAM
  // found (Deschaud, ICRA 2018, section V) and what later odometries use. Applied to KITTI raw drives, and to
  // odometry sequences with KITTI's calib.txt: others use that layout for other sensors.
  double kitti_vertical_angle_deg = 0.205;
  int sweeps = 0;  // sweeps after which the replay ends; 0: all
  int loops = 1;   // times that the recording is played; each begins anew, stamps go on
};

struct LoopSettings {
  bool by_surfaces = true;
  bool by_sight = false;  // where a camera is in use; backend/sight/README.md says why not by default
};

struct ColourSettings {
  bool from_camera = true;  // the map has the colours that a camera sees
  double range_max_m = 40;  // from where colours are believed
};

struct Settings {
  EstimatorConfig estimator;
  MappingConfig mapping;
  GraphConfig graph;
  LoopSettings loops;
  ColourSettings colour;
  ReplaySettings replay;
  double lost_after_s = 10;  // time without a pose that holds, after which the filter begins again; 0: never
  int threads = 2;           // 1: reading and registering take turns; 2: reading runs ahead. The result is the same
};

// A key and its value as they were written.
struct SettingChoice {
  std::string key;
  std::string value;
};

// Checks type and range. The error names the key, what was found, what was wanted, and for an unknown key the nearest.
Status set(Settings& settings, std::string_view key, std::string_view value);

// "key=value", as `--set` takes it.
Result<SettingChoice> parse_choice(std::string_view text);

// All settings in force, in the table's order, as text that set() reads back exactly.
std::vector<SettingChoice> choices_of(const Settings& settings);

// The parameter reference: key, default, range, unit, meaning; one a line.
std::string settings_reference();

// Unit and meaning of a key, as a comment beside its value: "[m] side of a map cell"; empty for an unknown key.
std::string comment_of(std::string_view key);

}  // namespace lxd
