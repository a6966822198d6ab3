// SPDX-License-Identifier: Apache-2.0
// A fix into NMEA 0183 sentences, by the parser's own table of fields.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/gnss/gnss_fix.hpp"

namespace lxd {

// What the label of an epoch is made of: unix time, and whether it is the second that a leap second adds (23:59:60).
struct UtcLabel {
  std::int64_t unix_ns = 0;
  bool leap = false;
};

// `$` body `*` checksum, without a line end.
std::string nmea_sentence(const std::string& body);

// GGA, RMC, GST and GSA of one epoch, in this order; what the fix does not know stays empty.
std::vector<std::string> encode_epoch(const GnssFix& fix, const UtcLabel& label);

}  // namespace lxd
