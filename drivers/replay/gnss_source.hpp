// SPDX-License-Identifier: Apache-2.0
// The GNSS receiver of a recording: gnss.nmea through the live rig's parser, fix by fix.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>

#include "drivers/gnss/nmea_parser.hpp"
#include "drivers/replay/nmea_log.hpp"

namespace lxd {

inline constexpr const char* kGnssFile = "gnss.nmea";

class GnssSource {
 public:
  // Error: the file cannot be read.
  static Result<GnssSource> open(const std::filesystem::path& file);

  // The next fix, with a position or without. None: the log has ended. Damage is passed over.
  std::optional<GnssFix> next();

 private:
  explicit GnssSource(NmeaLog log) : log_(std::move(log)) {}

  NmeaLog log_;
  NmeaParser parser_;
  std::deque<GnssFix> fixes_;  // of the line read last
  bool ended_ = false;
};

}  // namespace lxd
