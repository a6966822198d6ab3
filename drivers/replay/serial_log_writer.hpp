// SPDX-License-Identifier: Apache-2.0
// Writes the file of a recorded serial line (serial_log.hpp), for the recorder and the simulator.
#pragma once

#include <filesystem>
#include <span>

#include "drivers/replay/growing_file.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

class SerialLogWriter {
 public:
  // Errors, here and below, name the file and the system's cause.
  static Result<SerialLogWriter> create(const std::filesystem::path& path);

  // More bytes than a chunk may have become several chunks of one time; none: nothing.
  Status append(RigTime received, std::span<const std::uint8_t> bytes);
  // Everything is with the system, or it says why not. Nothing may be appended afterwards.
  Status close() { return file_.close(); }

  [[nodiscard]] GrowingFile& file() { return file_; }

 private:
  explicit SerialLogWriter(GrowingFile file) : file_(std::move(file)) {}

  GrowingFile file_;
};

}  // namespace lxd
