// SPDX-License-Identifier: Apache-2.0
#include "board/rig_wires.hpp"

#include <fmt/format.h>

#include "board/rig.hpp"
#include "drivers/device/ipv4.hpp"
#include "drivers/device/usb_bulk_api.hpp"
#include "drivers/replay/can_log.hpp"

namespace lxd {
namespace {

constexpr ValueRange kPort{1, 65'535, "", ""};

void read_address(YamlSection& section, std::string_view key, std::string& value, bool multicast) {
  section.read(key, value);
  if (value.empty()) return;
  const auto address = parse_ipv4(value);
  if (address && is_multicast(*address) == multicast) return;
  section.complain(key, fmt::format("found '{}', wanted an IPv4 address {}", value,
                                    multicast ? "of a group, 224.0.0.0 to 239.255.255.255" : "of one host"));
}

std::string line(std::string_view key, const std::string& value) {
  return value.empty() ? std::string() : fmt::format("  {}: {}\n", key, value);
}
std::string line(std::string_view key, std::uint32_t value) {
  return value == 0 ? std::string() : fmt::format("  {}: {}\n", key, value);
}

}  // namespace

void read_wire(YamlSection& section, LidarWire& wire) {
  read_address(section, "address", wire.address, false);
  section.read("port", wire.port, kPort);
  section.read("imu_port", wire.imu_port, kPort);
  if (wire.imu_port != 0 && wire.imu_port == wire.port)
    section.complain("imu_port", fmt::format("found {}, wanted another port than that of the points", wire.imu_port));
  read_address(section, "multicast_group", wire.multicast_group, true);
  section.read("metadata", wire.metadata);
  read_address(section, "host", wire.host, false);
  if (!wire.host.empty() && wire.port == 0)
    section.complain("host", "found it without port, wanted the port that the sensor is to send its points to, too");
}

void read_wire(YamlSection& section, SerialWire& wire) {
  section.read("device", wire.device);
  if (!wire.device.empty() && !wire.device.starts_with('/') && !parse_usb_device(wire.device))
    section.complain("device", fmt::format("found '{}', wanted a path from / on, such as /dev/serial/by-id/…, or "
                                           "usb:VENDOR:PRODUCT[:SERIAL]",
                                           wire.device));
}

void read_wire(YamlSection& section, CanWire& wire) {
  section.read("interface", wire.interface);
  if (wire.interface.size() > kCanInterfaceMax || wire.interface.find('/') != std::string::npos)
    section.complain("interface",
                     fmt::format("found '{}', wanted a network interface's name, such as can0", wire.interface));
}

std::string text_of(const LidarWire& wire) {
  return line("address", wire.address) + line("port", wire.port) + line("imu_port", wire.imu_port) +
         line("multicast_group", wire.multicast_group) + line("metadata", wire.metadata) + line("host", wire.host);
}

std::string text_of(const SerialWire& wire) { return line("device", wire.device); }
std::string text_of(const CanWire& wire) { return line("interface", wire.interface); }

std::vector<std::string> shared_wires(const Rig& rig) {
  std::vector<std::string> problems;
  if (rig.lidar1) {
    const LidarWire &a = rig.lidar0.wire, &b = rig.lidar1->wire;
    const bool apart = !a.address.empty() && !b.address.empty() && a.address != b.address;
    if (a.port != 0 && a.port == b.port && !apart)
      problems.push_back(fmt::format(
          "lidar1.port: found {}, which lidar0 has too; wanted another, or both with an address to tell them apart",
          b.port));
  }
  if (rig.imu && rig.gnss && !rig.imu->wire.device.empty() && rig.imu->wire.device == rig.gnss->wire.device)
    problems.push_back(fmt::format("gnss.device: found {}, which imu has too; wanted another", rig.gnss->wire.device));
  return problems;
}

}  // namespace lxd
