// SPDX-License-Identifier: Apache-2.0
// What a rig recording holds besides its LiDAR, read from end to end through the parsers of the live rig: for its
// faults, which a report tells, and for pictures. A replay's own readers are sensor_streams.
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
