// SPDX-License-Identifier: Apache-2.0
// See rig_recording.hpp.
#include "drivers/replay/rig_recording.hpp"

#include <fmt/format.h>

#include "drivers/replay/livox_pcap.hpp"
#include "drivers/replay/livox_stream.hpp"
#include "drivers/replay/ouster_pcap.hpp"
#include "drivers/replay/rig_clock.hpp"

namespace lxd {
namespace {

constexpr const char* kKind = "rig-recording";
constexpr const char* kCapture = "lidar0.pcap";
constexpr const char* kMetadata = "lidar0.json";

}  // namespace

bool is_rig_recording(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(folder / kCapture, ignored);
}

Result<std::unique_ptr<SweepSource>> open_rig_recording(const std::filesystem::path& folder) {
  return open_rig_recording(folder, std::make_unique<RigClock>(ClockModelConfig{}));
}

Result<std::unique_ptr<SweepSource>> open_rig_recording(const std::filesystem::path& folder,
                                                        std::unique_ptr<SweepClock> clock) {
  const std::filesystem::path capture = folder / kCapture;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(folder / kMetadata, ignored))
    return open_ouster_pcap(capture, std::move(clock), kKind);
  if (find_livox_stream(capture)) return open_livox_pcap(capture, std::move(clock), kKind);
  return Error{
      fmt::format("{}: found no point packets of a Livox sensor, and no {} beside it that would make it an "
                  "Ouster's; wanted one of the two",
                  capture.string(), kMetadata)};
}

}  // namespace lxd
