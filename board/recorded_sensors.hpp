// SPDX-License-Identifier: Apache-2.0
// What a rig recording holds besides its LiDAR, read through the parsers of the live rig. The filter of this version
// runs on the LiDAR alone; these are read so that a recording's faults are told, and drawn.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "board/rig.hpp"
#include "drivers/gnss/gnss_fix.hpp"
#include "drivers/replay/rejections.hpp"
#include "drivers/wheel/wheel_decoder.hpp"
#include "rt/imu_sample.hpp"
#include "rt/result.hpp"

namespace lxd {

// Called for each sample, in the order of the log. Empty: not wanted.
struct SensorReaders {
  std::function<void(const ImuSample&)> imu;
  std::function<void(const WheelSample&)> wheel;
  std::function<void(const GnssFix&)> gnss;
};

// Reads imu.serial, can.log and gnss.nmea, each if it is there and the rig has the sensor. Gives what was refused, by
// sensor and cause. Error: a log that is there and cannot be read.
Result<std::map<std::string, Rejections>> read_recorded_sensors(const std::filesystem::path& recording, const Rig& rig,
                                                                const SensorReaders& readers);

}  // namespace lxd
