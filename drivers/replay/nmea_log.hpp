// SPDX-License-Identifier: Apache-2.0
// `gnss.nmea` of a recording: `<host time s> <sentence>` a line. Gives bytes with their receive time, for NmeaParser.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

struct NmeaChunk {
  RigTime received;
  std::span<const std::uint8_t> bytes;  // the sentence with a line end; valid until the next read
};

class NmeaLog {
 public:
  // Error: the file cannot be read.
  static Result<NmeaLog> open(const std::filesystem::path& path);

  // False: the log has ended. A line without a time is counted and passed over; what follows the time is not looked at.
  bool next(NmeaChunk& chunk);

  [[nodiscard]] std::uint64_t lines() const { return lines_; }
  [[nodiscard]] std::uint64_t garbage() const { return garbage_; }
  [[nodiscard]] std::uint64_t first_garbage_line() const { return first_garbage_line_; }  // from 1; 0: none

 private:
  explicit NmeaLog(std::ifstream file) : file_(std::move(file)) {}

  std::ifstream file_;
  std::string line_;
  std::uint64_t line_number_ = 0, lines_ = 0, garbage_ = 0, first_garbage_line_ = 0;
};

}  // namespace lxd
