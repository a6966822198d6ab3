// SPDX-License-Identifier: Apache-2.0
// See nmea_framer.hpp.
#include "drivers/gnss/nmea_framer.hpp"

#include <numeric>

namespace lxd {
namespace {

constexpr std::size_t kChecksumChars = 3;  // "*7E"

bool is_text(std::uint8_t byte) { return byte >= 0x20 && byte < 0x7F; }

// Upper case, as the standard has it: a lower-case digit is a flipped bit.
std::optional<unsigned> hex_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10U;
  return std::nullopt;
}

}  // namespace

std::uint8_t nmea_checksum(std::string_view body) {
  return std::accumulate(body.begin(), body.end(), std::uint8_t{0}, [](std::uint8_t sum, char c) {
    return static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  });
}

std::optional<NmeaLine> NmeaFramer::push(std::uint8_t byte, RigTime received) {
  const bool line_end = byte == '\r' || byte == '\n';
  if (byte == '$') {
    begin(received);
  } else if (size_ == 0) {
    if (!line_end) ++counts_.skipped_bytes;
  } else if (line_end) {
    return end();
  } else if (is_text(byte)) {
    extend(static_cast<char>(byte));
  } else {
    ++counts_.broken;
    size_ = 0;
  }
  return std::nullopt;
}

void NmeaFramer::begin(RigTime received) {
  if (size_ != 0) ++counts_.broken;
  line_[0] = '$';
  size_ = 1;
  received_ = received;
}

void NmeaFramer::extend(char c) {
  if (size_ == line_.size()) {
    ++counts_.too_long;
    size_ = 0;
  } else {
    line_[size_++] = c;
  }
}

std::optional<NmeaLine> NmeaFramer::end() {
  const std::string_view line(line_.data(), size_);
  size_ = 0;
  if (line.size() < 1 + kChecksumChars || line[line.size() - kChecksumChars] != '*') {
    ++counts_.no_checksum;
    return std::nullopt;
  }
  const std::string_view body = line.substr(1, line.size() - 1 - kChecksumChars);
  const auto high = hex_digit(line[line.size() - 2]), low = hex_digit(line.back());
  if (!high || !low || (*high << 4U | *low) != nmea_checksum(body)) {
    ++counts_.bad_checksum;
    return std::nullopt;
  }
  ++counts_.lines;
  return NmeaLine{received_, body};
}

}  // namespace lxd
