// SPDX-License-Identifier: Apache-2.0
// What a live rig's file says besides: where each sensor's bytes come in. A recording's file may hold the same keys; a
// replay does not look at them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "board/yaml_section.hpp"

namespace lxd {

struct Rig;

// Below lidar0, lidar1. Empty or 0: not given.
struct LidarWire {
  std::string address;          // of the sensor, IPv4; empty: whoever sends
  std::uint32_t port = 0;       // of this host, for points; an Ouster's metadata may say it too
  std::uint32_t imu_port = 0;   // of this host, for the sensor's own IMU: recorded, not used
  std::string multicast_group;  // IPv4
  std::string metadata;  // an Ouster's, JSON; beside the rig file, or absolute; empty: the sensor is asked for it
  std::string host;      // this host as a Livox is to know it, IPv4; empty: the sensor is set up by others
};

// Below imu and gnss; gnss has its baud rate here too.
struct SerialWire {
  std::string device;  // a path, or for imu a USB device: parse_usb_device()
};

// Below wheel.
struct CanWire {
  std::string interface;
};

void read_wire(YamlSection& section, LidarWire& wire);
void read_wire(YamlSection& section, SerialWire& wire);
void read_wire(YamlSection& section, CanWire& wire);

// The lines of a rig file, two blanks in front of each; what is not given is left out.
std::string text_of(const LidarWire& wire);
std::string text_of(const SerialWire& wire);
std::string text_of(const CanWire& wire);

// Wires that two sensors cannot share, a sentence each: one port without addresses that tell the senders apart, one
// serial device twice.
std::vector<std::string> shared_wires(const Rig& rig);

}  // namespace lxd
