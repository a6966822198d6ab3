// SPDX-License-Identifier: Apache-2.0
// What each sensor sent and what faults did to it, for simulation.json.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/simulator/camera/write_camera.hpp"
#include "tools/simulator/gnss/gnss_writer.hpp"
#include "tools/simulator/imu/imu_writer.hpp"
#include "tools/simulator/lidar/lidar_log.hpp"
#include "tools/simulator/sync/sync_writer.hpp"
#include "tools/simulator/wheel/wheel_writer.hpp"

namespace lxd::sim {

nlohmann::ordered_json to_json(const LidarLog& log);
nlohmann::ordered_json to_json(const ImuWritten& log);
nlohmann::ordered_json to_json(const CameraLog& log);
nlohmann::ordered_json to_json(const WheelLog& log);
nlohmann::ordered_json to_json(const GnssLog& log);
nlohmann::ordered_json to_json(const SyncLog& log);

}  // namespace lxd::sim
