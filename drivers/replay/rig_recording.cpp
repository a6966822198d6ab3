// SPDX-License-Identifier: Apache-2.0
// See rig_recording.hpp.
#include "drivers/replay/rig_recording.hpp"

#include <fmt/format.h>

#include "drivers/replay/livox_pcap.hpp"
#include "drivers/replay/livox_stream.hpp"
#include "drivers/replay/ouster_pcap.hpp"
#include "drivers/replay/pcap_file.hpp"
#include "drivers/replay/pps_log.hpp"
#include "drivers/replay/rig_clock.hpp"

namespace lxd {
namespace {

constexpr const char* kKind = "rig-recording";
constexpr const char* kPrimary = "lidar0";

bool has_packets(const std::filesystem::path& capture) {
  auto pcap = PcapFile::open(capture);
  CapturedPacket packet;
  Rejections ignored;
  return pcap && pcap->next(packet, ignored);
}

}  // namespace

bool is_rig_recording(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(folder / "lidar0.pcap", ignored);
}

Result<std::unique_ptr<SweepSource>> open_rig_recording(const std::filesystem::path& folder, bool pulsed) {
  auto pulses = recorded_pulses(folder, pulsed);
  if (!pulses) return pulses.error();
  return open_rig_lidar(folder, kPrimary, std::make_unique<RigClock>(ClockModelConfig{}, std::move(*pulses)));
}

Result<std::unique_ptr<SweepSource>> open_rig_lidar(const std::filesystem::path& folder, const std::string& lidar,
                                                    std::unique_ptr<SweepClock> clock) {
  const std::filesystem::path capture = folder / (lidar + ".pcap"), metadata = folder / (lidar + ".json");
  std::error_code ignored;
  if (std::filesystem::is_regular_file(metadata, ignored)) return open_ouster_pcap(capture, std::move(clock), kKind);
  if (find_livox_stream(capture)) return open_livox_pcap(capture, std::move(clock), kKind);
  if (!has_packets(capture))
    return Error{
        fmt::format("{}: found no packet at all, wanted those of a LiDAR: it sent nothing while this was recorded",
                    capture.string())};
  return Error{
      fmt::format("{}: found no point packets of a Livox sensor, and no {} beside it that would make it an "
                  "Ouster's; wanted one of the two",
                  capture.string(), metadata.filename().string())};
}

}  // namespace lxd
