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
  // With the system; with the disk.
  virtual Status flush() { return file().flush(); }
  virtual Status sync() { return file().sync(); }
  virtual Status close() = 0;
  // Whole records that killing the process does not lose.
  [[nodiscard]] virtual std::uint64_t flushed_bytes() { return file().flushed_bytes(); }
  // Chunks that cannot be brought into the file's form.
  [[nodiscard]] virtual std::uint64_t refused() const { return 0; }

 protected:
  [[nodiscard]] virtual GrowingFile& file() = 0;  // or the one of them that all hangs on
};

// lidar0.pcap, lidar1.pcap, imu.serial, can.log, gnss.nmea, camera0/, pps.csv or gpio.csv of the recording. Error: it
// cannot be made.
Result<std::unique_ptr<ChunkFile>> create_chunk_file(LiveChannel channel, const Rig& rig,
                                                     const std::filesystem::path& recording);

}  // namespace lxd
