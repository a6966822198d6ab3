// SPDX-License-Identifier: Apache-2.0
// Writes gnss.nmea of a recording (nmea_log.hpp): what a receiver's line delivers, cut into sentences, each with the
// time at which its `$` came.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "drivers/replay/growing_file.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

class NmeaLogWriter {
 public:
  static constexpr std::size_t kLineMax = 256;  // of anything, sentence or not; what is longer becomes several lines

  static Result<NmeaLogWriter> create(const std::filesystem::path& path);

  Status append(RigTime received, std::span<const std::uint8_t> bytes);
  // With the sentence under way, as far as it came.
  Status close();

  [[nodiscard]] GrowingFile& file() { return file_; }

 private:
  explicit NmeaLogWriter(GrowingFile file) : file_(std::move(file)) {}
  Status push(std::uint8_t byte, RigTime received);
  Status end_line();

  GrowingFile file_;
  std::array<std::uint8_t, kLineMax> line_{};
  std::size_t size_ = 0;
  RigTime received_;
};

}  // namespace lxd
