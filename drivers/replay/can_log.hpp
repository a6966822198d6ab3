// SPDX-License-Identifier: Apache-2.0
// CAN logs as `candump -L` writes them (can-utils, lib.c): `(1436509052.249713) can0 123#DEADBEEF` a line. Ids of 8
// digits are extended; with bit 0x20000000 set the line is an error frame; `#R` or `#R4` is a remote frame.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/wheel/can_frame.hpp"
#include "rt/result.hpp"

namespace lxd {

inline constexpr std::size_t kCanInterfaceMax = 15;  // IFNAMSIZ without its NUL

struct CanLogRecord {
  CanFrame frame;  // received: the line's time, microseconds
  std::array<char, kCanInterfaceMax + 1> interface {};

  [[nodiscard]] std::string_view interface_name() const { return interface.data(); }
  void set_interface(std::string_view name) {  // what is too long is cut
    interface = {};
    name.copy(interface.data(), kCanInterfaceMax);
  }
};

enum class CanLogLine : std::uint8_t {
  frame,
  blank,
  can_fd,  // `##`: not a frame of a classic bus
  garbage  // anything else; the record is then without meaning
};

// One line, with or without its line end. Allocates nothing.
CanLogLine parse_can_log_line(std::string_view line, CanLogRecord& record);

// With its line end. Time is cut to the microsecond.
std::string can_log_line(const CanLogRecord& record);

class CanLogReader {
 public:
  static constexpr std::size_t kGarbageLinesKept = 16;

  // Error: the file cannot be read.
  static Result<CanLogReader> open(const std::filesystem::path& path);

  // False: the log has ended. Lines that are no frames are counted and passed over.
  bool next(CanLogRecord& record);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] std::uint64_t garbage() const { return garbage_; }
  [[nodiscard]] std::uint64_t can_fd() const { return can_fd_; }
  [[nodiscard]] std::uint64_t time_backwards() const { return time_backwards_; }  // frames, delivered none the less
  // Numbers (from 1) of the first lines that could not be read.
  [[nodiscard]] const std::vector<std::uint64_t>& garbage_lines() const { return garbage_lines_; }

 private:
  explicit CanLogReader(std::ifstream file) : file_(std::move(file)) {}
  bool take(CanLogLine kind, const CanLogRecord& record);

  std::ifstream file_;
  std::string line_;
  std::uint64_t line_number_ = 0, frames_ = 0, garbage_ = 0, can_fd_ = 0, time_backwards_ = 0;
  RigTime last_;
  std::vector<std::uint64_t> garbage_lines_;
};

}  // namespace lxd
