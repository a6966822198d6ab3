// SPDX-License-Identifier: Apache-2.0
#include "board/livox_set_up.hpp"

#include <array>
#include <optional>
#include <utility>

#include "drivers/device/ipv4.hpp"
#include "drivers/livox/control_device.hpp"

namespace lxd {
namespace {

// Which session the points of a channel belong to.
struct Listened {
  std::uint16_t points_port = 0;
  std::size_t session = 0;
};
using ListenedByChannel = std::array<std::optional<Listened>, kLiveChannels>;

// A device as it is, but that the control protocol is told of points.
class HeardDevice final : public Device {
 public:
  HeardDevice(std::unique_ptr<Device> device, LivoxControl& control, const ListenedByChannel& listened)
      : device_(std::move(device)), control_(control), listened_(listened) {}

  [[nodiscard]] const std::string& name() const override { return device_->name(); }
  [[nodiscard]] int fd() const override { return device_->fd(); }
  void read(ChunkSink& sink) override {
    Ears ears(*this, sink);
    device_->read(ears);
  }
  void tend(RigTime now) override { device_->tend(now); }
  [[nodiscard]] const std::string& trouble() const override { return device_->trouble(); }
  [[nodiscard]] const DeviceCounts& counts() const override { return device_->counts(); }

 private:
  class Ears final : public ChunkSink {
   public:
    Ears(HeardDevice& owner, ChunkSink& sink) : owner_(owner), sink_(sink) {}
    void take(const Chunk& chunk) override {
      const auto& listened = owner_.listened_[chunk.channel];
      if (listened && listened->points_port == chunk.origin.destination_port)
        owner_.control_.heard_points(listened->session, chunk.received);
      sink_.take(chunk);
    }

   private:
    HeardDevice& owner_;
    ChunkSink& sink_;
  };

  std::unique_ptr<Device> device_;
  LivoxControl& control_;
  ListenedByChannel listened_;
};

LivoxAddress livox_address(std::uint32_t address) {
  const auto byte = [&](unsigned shift) { return static_cast<std::uint8_t>(address >> shift & 0xFFU); };
  return {byte(24), byte(16), byte(8), byte(0)};
}

LivoxSessionConfig session_of(const LidarWire& wire) {
  LivoxSessionConfig config;
  config.host = livox_address(parse_ipv4(wire.host).value_or(0));
  if (const auto sensor = parse_ipv4(wire.address)) config.sensor = livox_address(*sensor);
  config.points_port = static_cast<std::uint16_t>(wire.port);
  config.imu_port = static_cast<std::uint16_t>(wire.imu_port);
  config.imu = wire.imu_port != 0;
  return config;
}

}  // namespace

void set_up_livox(std::span<const LiveLidar> lidars, std::vector<std::unique_ptr<Device>>& devices) {
  std::vector<LivoxSessionConfig> sessions;
  ListenedByChannel listened;
  for (const LiveLidar& lidar : lidars) {
    if (lidar.metadata || lidar.wire.host.empty()) continue;
    listened[index_of(lidar.channel)] = Listened{static_cast<std::uint16_t>(lidar.wire.port), sessions.size()};
    sessions.push_back(session_of(lidar.wire));
  }
  if (sessions.empty()) return;
  auto control = std::make_unique<LivoxControl>(std::move(sessions), LivoxHostPorts{});
  for (auto& device : devices) device = std::make_unique<HeardDevice>(std::move(device), *control, listened);
  devices.push_back(std::move(control));
}

}  // namespace lxd
