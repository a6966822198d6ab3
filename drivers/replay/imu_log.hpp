// SPDX-License-Identifier: Apache-2.0
// The IMU of a rig recording, sample by sample, through the parser that a live rig uses.
#pragma once

#include <cstdint>
#include <filesystem>

#include "drivers/imu/imu_stream.hpp"
#include "drivers/replay/serial_log.hpp"
#include "rt/imu_sample.hpp"

namespace lxd {

class ImuLog {
 public:
  // Errors as SerialLog::open. Precondition: baud_rate > 0.
  static Result<ImuLog> open(const std::filesystem::path& path, ImuProtocol protocol, double baud_rate);
  ImuLog(SerialLog log, ImuProtocol protocol, double baud_rate);

  // False at the recording's end. Damage is counted and passed over.
  bool next(ImuSample& sample);

  // Of the file and of the parser, since the start, by cause.
  [[nodiscard]] Rejections rejected() const;
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }  // read from the line so far

 private:
  bool feed();

  SerialLog log_;
  ImuStream stream_;
  SerialChunk chunk_;
  Rejections file_rejected_;
  std::uint64_t samples_ = 0, bytes_ = 0;
};

}  // namespace lxd
