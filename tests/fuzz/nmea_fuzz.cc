// SPDX-License-Identifier: Apache-2.0
// Any bytes as a receiver's stream: fixes are places on Earth, and chunks do not matter. The first byte is the size of
// a chunk.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "drivers/gnss/enu.hpp"
#include "drivers/gnss/gnss_covariance.hpp"
#include "drivers/gnss/nmea_parser.hpp"

namespace {

using namespace lxd;

void check(const GnssFix& fix) {
  static const Result<EnuFrame> frame = EnuFrame::at({47, 8, 400});
  if (fix.has_position()) {
    if (std::abs(*fix.latitude_deg) > 90 || std::abs(*fix.longitude_deg) > 180) std::abort();
    if (!frame->to_enu({*fix.latitude_deg, *fix.longitude_deg, fix.ellipsoid_height_m().value_or(0)}).allFinite())
      std::abort();
  }
  const auto covariance = covariance_of(fix);
  if (covariance && !covariance->enu_m2.allFinite()) std::abort();
  if (fix.time_of_day_ns < 0 || fix.time_of_day_ns > 86'401 * kNanosPerSecond) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::uint8_t> stream(data + 1, size - 1);
  const std::size_t chunk = 1U + data[0];
  NmeaParser whole, parts;
  whole.feed(stream, {}, check);
  for (std::size_t at = 0; at < stream.size(); at += chunk)
    parts.feed(stream.subspan(at, std::min(chunk, stream.size() - at)), {}, check);
  if (whole.counts().fixes != parts.counts().fixes) std::abort();
  if (const auto last = whole.flush()) check(*last);
  return 0;
}
