// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/recording_size.hpp"

#include "drivers/ouster/packet_format.hpp"

namespace lxd::sim {
namespace {

constexpr double kPacketOverhead = 1.05;    // headers of packets, frames and records
constexpr double kLivoxBytesPerPoint = 14;  // type 1
constexpr double kLivoxPointsPerSecond = 200'000;
constexpr double kPngBytesPerByte = 0.7;          // of textured, noisy images
constexpr double kOtherBytesPerSecond = 100'000;  // serial lines, buses, truth
constexpr double kVertexBytes = 12, kFaceBytes = 14;

double bytes_per_second(const OusterConfig& config) {
  const OusterProfile* const profile = find_ouster_profile(config.profile);
  const double pixel_bytes = profile == nullptr ? 0 : static_cast<double>(profile->channel_bytes);
  return kPacketOverhead * pixel_bytes * config.beams * config.columns * config.rate_hz;
}

double bytes_per_second(const LivoxConfig&) { return kPacketOverhead * kLivoxBytesPerPoint * kLivoxPointsPerSecond; }

double bytes_per_second(const LidarConfig& config) {
  return std::visit([](const auto& lidar) { return bytes_per_second(lidar); }, config);
}

double bytes_per_second(const CameraConfig& config) {
  const double image_bytes = 1.0 * config.resolution[0] * config.resolution[1] * (config.colour ? 3 : 1);
  return kPngBytesPerByte * image_bytes * config.rate_hz;
}

}  // namespace

std::uint64_t expected_bytes(const Scenario& scenario, const World& world) {
  double rate = kOtherBytesPerSecond + bytes_per_second(scenario.lidar0);
  if (scenario.lidar1) rate += bytes_per_second(*scenario.lidar1);
  if (scenario.camera0) rate += bytes_per_second(*scenario.camera0);
  const double world_bytes =
      kVertexBytes * static_cast<double>(world.vertices.size()) + kFaceBytes * static_cast<double>(world.faces.size());
  return static_cast<std::uint64_t>(rate * scenario.duration_s + world_bytes);
}

}  // namespace lxd::sim
