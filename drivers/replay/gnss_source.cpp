// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/gnss_source.hpp"

namespace lxd {

Result<GnssSource> GnssSource::open(const std::filesystem::path& file) {
  auto log = NmeaLog::open(file);
  if (!log) return log.error();
  return GnssSource(std::move(*log));
}

std::optional<GnssFix> GnssSource::next() {
  NmeaChunk chunk;
  while (fixes_.empty() && log_.next(chunk))
    parser_.feed(chunk.bytes, chunk.received, [this](const GnssFix& fix) { fixes_.push_back(fix); });
  if (fixes_.empty() && !ended_) {
    ended_ = true;
    return parser_.flush();
  }
  if (fixes_.empty()) return std::nullopt;
  const GnssFix fix = fixes_.front();
  fixes_.pop_front();
  return fix;
}

}  // namespace lxd
