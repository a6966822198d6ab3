// SPDX-License-Identifier: Apache-2.0
// A rig file made ready to be run or recorded: which of its sensors have a wire, and what their bytes mean.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/live_channel.hpp"
#include "board/rig.hpp"
#include "board/sensor_set.hpp"
#include "drivers/device/device.hpp"
#include "drivers/device/host_clock.hpp"
#include "drivers/device/system_calls.hpp"
#include "drivers/ouster/metadata.hpp"
#include "drivers/sync/libgpiod_line.hpp"
#include "rt/result.hpp"

namespace lxd {

struct LiveLidar {
  LiveChannel channel = LiveChannel::lidar0;
  LidarWire wire;                          // with its port
  std::string metadata_text;               // an Ouster's JSON; empty: a Livox
  std::optional<OusterMetadata> metadata;  // of that text
};

struct LiveRig {
  Rig rig;
  SensorSet sensors;                     // that have a wire
  bool pulse = false, triggers = false;  // likewise
  std::vector<LiveLidar> lidars;
  std::vector<std::string> remarks;  // sensors of the rig that are left out, and why

  // The IMU is the one inside the primary LiDAR.
  [[nodiscard]] bool uses_lidar_imu() const { return sensors.imu && rig.imu->of_lidar(); }
};

// Reads the metadata that the rig names, relative to `folder`, the rig file's, or asks the sensor for it. Error: all
// that is missing or unreadable.
Result<LiveRig> make_live(const Rig& rig, const std::filesystem::path& folder);

// The kernel that devices other than sockets and terminals are asked of; tests stand in for it.
struct LiveKernel {
  using MakeGpio = std::function<std::unique_ptr<GpioApi>()>;
  SystemCalls* calls = &kernel_calls();
  MakeGpio gpio = [] { return std::make_unique<LibgpiodLine>(); };
};

struct LiveDevices {
  std::vector<std::unique_ptr<Device>> devices;
  std::unique_ptr<Device> camera;    // none: not in use. Opening it takes tenths of a second: it wants its own thread
  std::vector<std::string> remarks;  // a receive buffer that the kernel did not grant
};

enum class LidarPorts : std::uint8_t { points, points_and_imu };

// Ports are bound at once; all others may come later. Error: a port cannot be had. `clock` and the kernel's calls
// outlive the devices.
Result<LiveDevices> open_devices(const LiveRig& live, LidarPorts ports, const HostClock& clock,
                                 const LiveKernel& kernel = {});

}  // namespace lxd
