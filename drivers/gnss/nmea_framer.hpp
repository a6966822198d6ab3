// SPDX-License-Identifier: Apache-2.0
// Finds the lines of NMEA 0183 in a stream of bytes: `$` body `*` two hex digits, then CR or LF. Allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "rt/time.hpp"

namespace lxd {

// Characters of a line from `$` to the checksum's last digit. The standard says 82 with the line end; receivers send
// more (gpsd allows 130).
inline constexpr std::size_t kNmeaLineMax = 130;

struct NmeaLine {
  RigTime received;       // of the bytes that held the `$`
  std::string_view body;  // between `$` and `*`; valid until the next push
};

struct NmeaFramerCounts {
  std::uint64_t lines = 0;          // with the right checksum
  std::uint64_t skipped_bytes = 0;  // outside lines, line ends not counted
  std::uint64_t bad_checksum = 0, no_checksum = 0, too_long = 0;
  std::uint64_t broken = 0;  // a line that a new `$` or a byte that is no text cut off
};

class NmeaFramer {
 public:
  std::optional<NmeaLine> push(std::uint8_t byte, RigTime received);

  [[nodiscard]] const NmeaFramerCounts& counts() const { return counts_; }

 private:
  void begin(RigTime received);
  void extend(char c);
  std::optional<NmeaLine> end();

  std::array<char, kNmeaLineMax> line_{};
  std::size_t size_ = 0;  // 0: between lines
  RigTime received_;
  NmeaFramerCounts counts_;
};

// XOR of the body's characters.
std::uint8_t nmea_checksum(std::string_view body);

}  // namespace lxd
