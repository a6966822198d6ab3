// SPDX-License-Identifier: Apache-2.0
// When a sensor's own clock shows a number.
#pragma once

#include "tools/simulator/clock.hpp"

namespace lxd::sim {

// The true instant at which the sensor's clock, without jitter, shows sensor_ns. Newton: the clock is nearly the rig's,
// so each step gains three digits and more.
inline RigTime rig_time_of(const SensorClock& clock, std::int64_t sensor_ns) {
  constexpr int kSteps = 6;
  RigTime t = RigTime::from_ns(sensor_ns);
  for (int i = 0; i < kSteps; ++i) t = t + Duration::from_ns(sensor_ns - clock.sensor_ns(t));
  return t;
}

// The first multiple of period_ns that the sensor's clock shows at or after t. Precondition: the clock shows no
// negative number there.
inline std::int64_t first_multiple(const SensorClock& clock, RigTime t, std::int64_t period_ns) {
  return (clock.sensor_ns(t) + period_ns - 1) / period_ns * period_ns;
}

}  // namespace lxd::sim
