// SPDX-License-Identifier: Apache-2.0
#include "board/live_rig.hpp"

#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "board/livox_set_up.hpp"
#include "board/signal_devices.hpp"
#include "board/wheel_table.hpp"
#include "drivers/device/can_socket.hpp"
#include "drivers/device/ipv4.hpp"
#include "drivers/device/libusb_bulk.hpp"
#include "drivers/device/serial_port.hpp"
#include "drivers/device/udp_socket.hpp"
#include "drivers/device/usb_bulk.hpp"
#include "drivers/ouster/metadata_fetch.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

Result<std::string> read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  if (in) text << in.rdbuf();
  if (in && text) return text.str();
  return Error{fmt::format("{}: cannot be read, wanted an Ouster sensor's metadata", file.string())};
}

// From the sensor itself, which must be there for it.
Result<LiveLidar> ask_ouster(LiveLidar lidar) {
  const Duration deadline = Duration::from_seconds(5);
  auto fetched = fetch_ouster_metadata({lidar.wire.address}, deadline);
  if (!fetched) return Error{fmt::format("{}.metadata: {}", name_of(lidar.channel), fetched.error().message)};
  lidar.metadata_text = std::move(fetched->json);
  lidar.metadata = std::move(fetched->metadata);
  return lidar;
}

Result<LiveLidar> read_ouster(const LidarRig& rig, LiveLidar lidar, const fs::path& folder) {
  if (rig.wire.metadata.empty())
    return Error{fmt::format(
        "{}.metadata: found nothing, wanted the JSON file of the sensor's metadata, its address, or model: livox",
        name_of(lidar.channel))};
  const fs::path file = folder / rig.wire.metadata;
  auto text = read_text(file);
  if (!text) return text.error();
  auto metadata = parse_ouster_metadata(*text, file.string());
  if (!metadata) return metadata.error();
  lidar.metadata_text = std::move(*text);
  lidar.metadata = std::move(*metadata);
  return lidar;
}

Result<LiveLidar> make_ouster(const LidarRig& rig, LiveLidar lidar, const fs::path& folder) {
  const bool ask = rig.wire.metadata.empty() && !rig.wire.address.empty();
  auto made = ask ? ask_ouster(std::move(lidar)) : read_ouster(rig, std::move(lidar), folder);
  if (made && made->wire.port == 0) made->wire.port = made->metadata->lidar_port.value_or(0);
  return made;
}

Result<LiveLidar> make_lidar(const LidarRig& rig, LiveChannel channel, const fs::path& folder) {
  LiveLidar lidar;
  lidar.channel = channel;
  lidar.wire = rig.wire;
  Result<LiveLidar> made = rig.model == "livox" ? Result<LiveLidar>(lidar) : make_ouster(rig, lidar, folder);
  if (made && made->wire.port == 0)
    return Error{fmt::format("{}.port: found nothing, wanted the port of this host that the sensor sends its points to",
                             name_of(channel))};
  return made;
}

class LiveRigMaker {
 public:
  LiveRigMaker(const Rig& rig, const fs::path& folder) : folder_(folder) { live_.rig = rig; }

  Result<LiveRig> make() {
    const Rig& rig = live_.rig;
    add_lidar(rig.lidar0, LiveChannel::lidar0);
    if (rig.lidar1 && wired(rig.lidar1->wire)) add_lidar(*rig.lidar1, LiveChannel::lidar1);
    live_.sensors.extra_lidar = live_.lidars.size() > 1;
    live_.sensors.imu = rig.imu && (rig.imu->of_lidar() ? hears_lidar_imu() : !rig.imu->wire.device.empty());
    live_.sensors.wheel = rig.wheel && !rig.wheel->wire.interface.empty();
    live_.sensors.gnss = rig.gnss && !rig.gnss->wire.device.empty();
    if (rig.lidar1 && !live_.sensors.extra_lidar) leave_out("lidar1", "lidar1.port, lidar1.address or lidar1.metadata");
    if (rig.imu && !live_.sensors.imu) leave_out("imu", rig.imu->of_lidar() ? "lidar0.imu_port" : "imu.device");
    if (rig.wheel && !live_.sensors.wheel) leave_out("wheel", "wheel.interface");
    if (rig.gnss && !live_.sensors.gnss) leave_out("gnss", "gnss.device");
    add_camera();
    live_.pulse = rig.pps && rig.pps->wired();
    live_.triggers = rig.triggers && rig.triggers->camera0.given();
    if (rig.pps && !live_.pulse) leave_out("pps", "pps.device, or pps.chip and pps.line");
    if (rig.triggers && !live_.triggers) leave_out("triggers", "triggers.chip and triggers.camera0");
    if (problems_.empty()) return std::move(live_);
    return Error{problems_};
  }

 private:
  static bool wired(const LidarWire& wire) { return wire.port != 0 || !wire.metadata.empty() || !wire.address.empty(); }

  // An Ouster's metadata may say the port.
  bool hears_lidar_imu() {
    if (live_.lidars.empty()) return false;
    LiveLidar& lidar = live_.lidars.front();
    if (lidar.wire.imu_port == 0 && lidar.metadata) lidar.wire.imu_port = lidar.metadata->imu_port.value_or(0);
    return lidar.wire.imu_port != 0;
  }

  void add_lidar(const LidarRig& rig, LiveChannel channel) {
    auto lidar = make_lidar(rig, channel, folder_);
    if (lidar) return live_.lidars.push_back(std::move(*lidar));
    complain(lidar.error().message);
  }

  void add_camera() {
    const Rig& rig = live_.rig;
    live_.sensors.camera = rig.camera0 && !rig.camera0->wire.device.empty();
    if (rig.camera0 && !live_.sensors.camera) return leave_out("camera0", "camera0.device");
    if (rig.camera0 && rig.camera0->wire.by_triggers() && !rig.triggers->camera0.given())
      complain(
          "camera0.stamp: found trigger without triggers.chip and triggers.camera0, wanted the line of its trigger");
  }

  void complain(const std::string& problem) {
    if (!problems_.empty()) problems_ += '\n';
    problems_ += problem;
  }

  void leave_out(std::string_view sensor, std::string_view key) {
    live_.remarks.push_back(fmt::format("{} is left out: the rig file has no {}", sensor, key));
  }

  LiveRig live_;
  fs::path folder_;
  std::string problems_;
};

// Ports by number, each with all the sensors that send to it.
std::map<std::uint16_t, UdpConfig> ports_of(const LiveRig& live, LidarPorts ports) {
  std::map<std::uint16_t, UdpConfig> all;
  const auto add = [&](const LiveLidar& lidar, std::uint32_t number) {
    const auto port = static_cast<std::uint16_t>(number);
    UdpConfig& config = all[port];
    config.port = port;
    config.sources.push_back(
        {parse_ipv4(lidar.wire.address).value_or(0), static_cast<std::uint8_t>(index_of(lidar.channel))});
    if (!lidar.wire.multicast_group.empty())
      config.multicast_group = parse_ipv4(lidar.wire.multicast_group).value_or(0);
  };
  for (const LiveLidar& lidar : live.lidars) {
    add(lidar, lidar.wire.port);
    const bool used = lidar.channel == LiveChannel::lidar0 && live.uses_lidar_imu();
    if (lidar.wire.imu_port == 0 || lidar.wire.imu_port == lidar.wire.port) continue;
    if (used || ports == LidarPorts::points_and_imu) add(lidar, lidar.wire.imu_port);
  }
  return all;
}

Status open_ports(const LiveRig& live, LidarPorts ports, const HostClock& clock, LiveDevices& out) {
  for (const auto& [number, config] : ports_of(live, ports)) {
    auto socket = UdpSocket::open(config, clock);
    if (!socket) return socket.error();
    if ((*socket)->receive_buffer_bytes() < config.receive_buffer_bytes)
      out.remarks.push_back(fmt::format("udp {}: found a receive buffer of {} kB, wanted {} kB (net.core.rmem_max)",
                                        number, (*socket)->receive_buffer_bytes() / 1000,
                                        config.receive_buffer_bytes / 1000));
    out.devices.push_back(std::move(*socket));
  }
  return success();
}

std::vector<CanId> ids_of(const WheelRig& rig) {
  std::vector<CanId> ids;
  for (const CanMessage& message : wheel_messages(rig)) ids.push_back({message.id, message.extended});
  return ids;
}

}  // namespace

Result<LiveRig> make_live(const Rig& rig, const fs::path& folder) { return LiveRigMaker(rig, folder).make(); }

Result<LiveDevices> open_devices(const LiveRig& live, LidarPorts ports, const HostClock& clock,
                                 const LiveKernel& kernel) {
  LiveDevices opened;
  const Status bound = open_ports(live, ports, clock, opened);
  if (!bound) return bound.error();
  set_up_livox(live.lidars, opened.devices);
  const Rig& rig = live.rig;
  const auto serial = [&](const std::string& path, double baud_rate, LiveChannel channel) {
    opened.devices.push_back(std::make_unique<SerialPort>(
        SerialConfig{path, static_cast<std::uint32_t>(baud_rate), number_of(channel)}, clock));
  };
  if (live.sensors.imu && !live.uses_lidar_imu()) {
    if (auto usb = parse_usb_device(rig.imu->wire.device)) {
      usb->channel = number_of(LiveChannel::imu);
      opened.devices.push_back(std::make_unique<UsbBulk>(std::move(*usb), clock, std::make_unique<LibusbBulk>()));
    } else {
      serial(rig.imu->wire.device, rig.imu->baud_rate, LiveChannel::imu);
    }
  }
  if (live.sensors.gnss) serial(rig.gnss->wire.device, rig.gnss->baud_rate, LiveChannel::gnss);
  if (live.sensors.wheel)
    opened.devices.push_back(std::make_unique<CanSocket>(
        CanConfig{rig.wheel->wire.interface, ids_of(*rig.wheel), number_of(LiveChannel::wheel)}, clock));
  open_signals(live, clock, kernel, opened);
  return opened;
}

}  // namespace lxd
