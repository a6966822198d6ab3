// SPDX-License-Identifier: Apache-2.0
// NMEA text for tests: sentences with their checksums, and the fixes that a parser makes of a stream.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "drivers/gnss/nmea_parser.hpp"

namespace lxd::test {

inline std::string sentence(const std::string& body) {
  constexpr const char* kHex = "0123456789ABCDEF";
  const std::uint8_t sum = nmea_checksum(body);
  return "$" + body + "*" + kHex[sum >> 4U] + kHex[sum & 15U] + "\r\n";
}

inline std::span<const std::uint8_t> bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

inline std::vector<GnssFix> fixes_of(NmeaParser& parser, const std::string& text, RigTime received = {}) {
  std::vector<GnssFix> fixes;
  parser.feed(bytes(text), received, [&](const GnssFix& fix) { fixes.push_back(fix); });
  if (const auto last = parser.flush()) fixes.push_back(*last);
  return fixes;
}

}  // namespace lxd::test
