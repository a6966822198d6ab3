// SPDX-License-Identifier: Apache-2.0
// Whether a sensor's stamps stay numbers that its packets can hold, whatever offset, skew and faults do to its clock.
#pragma once

#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "tools/simulator/clock.hpp"
#include "tools/simulator/context.hpp"

namespace lxd::sim {

// The recording's begin and end, and every begin and end of a fault between them. From one to the next a sensor's clock
// only goes forward, so what it shows at them bounds what it ever shows, but for the instant before each.
std::vector<double> clock_instants(const Context& context);

inline constexpr std::int64_t kLatestStamp_ns = std::int64_t{1} << 62U;  // year 2116: later ones the parsers refuse
inline constexpr double kLeastJitters = 8;                               // normal noise goes that far once in 10^15

// stamp_ns(t_s): the clock without jitter. silent(t_s): nothing is stamped then. Error: sensor, stamp and time.
template <typename StampNs, typename Silent>
Status check_stamps(const Context& context, std::string_view sensor, const ClockConfig& clock, const StampNs& stamp_ns,
                    const Silent& silent) {
  const std::int64_t least_ns = Duration::from_seconds(kLeastJitters * clock.jitter_s).ns();
  for (const double t_s : clock_instants(context)) {
    const std::int64_t found_ns = stamp_ns(t_s);
    if (silent(t_s) || (found_ns >= least_ns && found_ns < kLatestStamp_ns - least_ns)) continue;
    return Error{
        fmt::format("{}: clock: found a stamp of {} ns at {} s, wanted none before the clock's zero and none "
                    "after the year 2115",
                    sensor, found_ns, t_s)};
  }
  return success();
}

// The same of a clock that no fault can step.
Status check_clock(const Context& context, std::string_view sensor, const ClockConfig& clock);

}  // namespace lxd::sim
