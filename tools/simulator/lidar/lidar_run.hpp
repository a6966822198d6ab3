// SPDX-License-Identifier: Apache-2.0
// What writers of LiDARs share: sweeps made by several threads and taken in order, with progress and a way to stop.
#pragma once

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "tools/simulator/clock_check.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/lidar/lidar_clock.hpp"
#include "tools/simulator/lidar/lidar_output.hpp"
#include "tools/simulator/lidar/ordered_work.hpp"

namespace lxd::sim {

// Whole periods in the recording; a last one that rounding would cost counts as whole.
inline std::uint64_t whole_periods(const Context& context, double rate_hz) {
  constexpr double kRounding = 1e-6;
  return static_cast<std::uint64_t>(context.duration_s * rate_hz + kRounding);
}

template <typename T, typename Make, typename Take>
Status run_sweeps(std::uint64_t sweeps, const LidarOutput& output, const Make& make, const Take& take) {
  return work_in_order<T>(sweeps, output.threads, make, [&](std::size_t i, T made) -> Status {
    if (output.stop != nullptr && output.stop->load()) return Error{"stopped"};
    const Status taken = take(std::move(made));
    if (taken.ok() && output.progress) output.progress(static_cast<double>(i + 1) / static_cast<double>(sweeps));
    return taken;
  });
}

// Errors that a scenario can be told before work begins.
template <typename Config>
Status check_lidar(const Context& context, const Config& config, double rate_hz) {
  if (whole_periods(context, rate_hz) == 0) {
    return Error{fmt::format("{}: found a recording of {} s, wanted at least a sweep of {} s", config.sensor,
                             context.duration_s, 1 / rate_hz)};
  }
  const LidarFaults faults(context.faults, config.sensor);
  const LidarClock clock(config.clock, config.own_epoch(), context, faults);
  return check_stamps(
      context, config.sensor, config.clock, [&](double t_s) { return clock.stamp_ns(t_s); },
      [&](double t_s) { return faults.silent(t_s); });
}

}  // namespace lxd::sim
