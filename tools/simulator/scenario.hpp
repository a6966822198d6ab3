// SPDX-License-Identifier: Apache-2.0
// A scenario: which world, which motion, which sensors. Read from a small YAML file with every problem told at once.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "rt/result.hpp"
#include "rt/time.hpp"
#include "tools/simulator/camera/camera_config.hpp"
#include "tools/simulator/gnss/gnss_config.hpp"
#include "tools/simulator/imu/imu_config.hpp"
#include "tools/simulator/lidar/livox_config.hpp"
#include "tools/simulator/lidar/ouster_config.hpp"
#include "tools/simulator/motion/motion_config.hpp"
#include "tools/simulator/sync/sync_config.hpp"
#include "tools/simulator/wheel/wheel_config.hpp"

namespace lxd::sim {

using LidarConfig = std::variant<OusterConfig, LivoxConfig>;

// Of a recording; beyond it, it is a mistake.
inline constexpr ValueRange kDurationRange{0.1, 4 * 3600, "s", "is it in milliseconds?"};

struct Scenario {
  std::string name;
  std::string text;   // the file as it was read
  std::string world;  // a kind of make_world, or the path of a PLY or OBJ file
  bool world_is_file = false;
  MotionConfig motion;
  double duration_s = 60;
  RigTime start = RigTime::from_ns(1'767'268'800 * kNanosPerSecond);  // 2026-01-01 12:00:00 UTC
  LidarConfig lidar0;
  std::optional<LidarConfig> lidar1;
  std::optional<ImuConfig> imu;
  std::optional<CameraConfig> camera0;
  std::optional<WheelConfig> wheel;
  std::optional<GnssConfig> gnss;
  std::optional<SyncConfig> sync;
};

// A world's or a path's file that a scenario names is meant from where the scenario's file is.
//
// `what`: the name of a shipped scenario, or a file. Errors: neither (with the nearest names), or every problem of the
// file, a line each: file:line: key: found and wanted.
Result<Scenario> load_scenario(const std::string& what);
Result<Scenario> parse_scenario(std::string text, const std::string& file);

}  // namespace lxd::sim
