// SPDX-License-Identifier: Apache-2.0
// A sensor's own clock against the rig's, and the way of its bytes to the host.
#pragma once

#include <cstdint>

#include "rt/time.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim {

// What the scenario says of one sensor's `clock`.
struct ClockConfig {
  double offset_s = 0;          // sensor minus rig, at the recording's start
  double skew_ppm = 0;          // how much faster the sensor's clock runs
  double jitter_s = 0;          // standard deviation of one stamp
  double latency_s = 0;         // least time from a sample to its receive stamp at the host
  double latency_jitter_s = 0;  // mean of the exponential delay on top
};

// Maps rig time (which is true time: the host's clock) to the sensor's stamps and to receive stamps.
class SensorClock {
 public:
  SensorClock(const ClockConfig& config, RigTime start) : config_(config), start_(start) {}

  // The sensor's clock at a true instant, without jitter; ns of the sensor's own epoch. Negative results are the
  // caller's to refuse (a scenario with such an offset is an error of the scenario).
  [[nodiscard]] std::int64_t sensor_ns(RigTime t) const {
    const double drift_s = (t - start_).seconds() * config_.skew_ppm * kPpm;
    // Each rounded for itself: in a double, an offset of decades leaves a drift steps of 240 ns.
    return t.ns() + Duration::from_seconds(config_.offset_s).ns() + Duration::from_seconds(drift_s).ns();
  }
  [[nodiscard]] std::int64_t stamped_ns(RigTime t, Random& random) const {
    return sensor_ns(t) + Duration::from_seconds(random.normal(config_.jitter_s)).ns();
  }
  // When the host's kernel stamps what was sent at t. Not monotonic by itself: the writer keeps the order of a wire.
  [[nodiscard]] RigTime received(RigTime t, Random& random) const {
    return t + Duration::from_seconds(config_.latency_s - config_.latency_jitter_s * std::log(1 - random.uniform()));
  }

 private:
  static constexpr double kPpm = 1e-6;
  ClockConfig config_;
  RigTime start_;
};

}  // namespace lxd::sim
