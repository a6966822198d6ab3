// SPDX-License-Identifier: Apache-2.0
// Writes the file of a recorded serial line (serial_log.hpp), for the recorder and the simulator.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

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
  Status close();

 private:
  struct Close {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  SerialLogWriter(std::FILE* stream, std::string name) : stream_(stream), name_(std::move(name)) {}
  Status write(std::span<const std::uint8_t> bytes);
  [[nodiscard]] Error failure() const;

  std::unique_ptr<std::FILE, Close> stream_;
  std::string name_;
};

}  // namespace lxd
