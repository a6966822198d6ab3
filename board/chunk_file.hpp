// SPDX-License-Identifier: Apache-2.0
// The file of a recording that a sensor's chunks go into, in the form that a replay reads.
#pragma once

#include <filesystem>
#include <memory>

#include "board/live_channel.hpp"
#include "board/rig.hpp"
#include "drivers/device/device.hpp"
#include "drivers/replay/growing_file.hpp"
#include "rt/result.hpp"

namespace lxd {

class ChunkFile {
 public:
  virtual ~ChunkFile() = default;
  // After the first error it takes nothing more.
  virtual Status append(const Chunk& chunk) = 0;
  virtual Status close() = 0;
  [[nodiscard]] virtual GrowingFile& file() = 0;
};

// lidar0.pcap, lidar1.pcap, imu.serial, can.log or gnss.nmea of the recording. Error: it cannot be made.
Result<std::unique_ptr<ChunkFile>> create_chunk_file(LiveChannel channel, const Rig& rig,
                                                     const std::filesystem::path& recording);

}  // namespace lxd
