// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/clock_check.hpp"

namespace lxd::sim {

std::vector<double> clock_instants(const Context& context) {
  std::vector<double> instants{0, context.duration_s};
  for (const Fault& fault : context.faults.all()) {
    for (const double t_s : {fault.begin_s, fault.end_s}) {
      if (t_s > 0 && t_s < context.duration_s) instants.push_back(t_s);
    }
  }
  return instants;
}

Status check_clock(const Context& context, std::string_view sensor, const ClockConfig& config) {
  const SensorClock clock(config, context.start);
  return check_stamps(
      context, sensor, config, [&](double t_s) { return clock.sensor_ns(context.rig_time(t_s)); },
      [](double) { return false; });
}

}  // namespace lxd::sim
