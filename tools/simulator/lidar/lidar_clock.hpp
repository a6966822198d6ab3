// SPDX-License-Identifier: Apache-2.0
// The stamps of a LiDAR: on the time of day (PTP), or on its own oscillator since it was switched on.
#pragma once

#include <cstdint>

#include "tools/simulator/clock.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/lidar/lidar_faults.hpp"

namespace lxd::sim {

// How long a LiDAR with a clock of its own has been running when the recording starts.
inline constexpr double kLidarUptime_s = 60;

// What SensorClock's time of day is moved by in the stamps of a sensor with a clock of its own that never restarted.
inline std::int64_t uptime_shift_ns(RigTime start) { return Duration::from_seconds(kLidarUptime_s).ns() - start.ns(); }

class LidarClock {
 public:
  LidarClock(const ClockConfig& config, bool own_epoch, const Context& context, const LidarFaults& faults)
      : clock_(config, context.start), own_epoch_(own_epoch), context_(context), faults_(faults) {}

  // ns of the sensor's epoch, without jitter.
  [[nodiscard]] std::int64_t stamp_ns(double t_s) const {
    const std::int64_t base_ns = clock_.sensor_ns(context_.rig_time(t_s));
    return base_ns + epoch_shift_ns(t_s) + Duration::from_seconds(faults_.clock_error_s(t_s)).ns();
  }
  [[nodiscard]] std::int64_t stamped_ns(double t_s, Random& random) const {
    const RigTime t = context_.rig_time(t_s);
    return stamp_ns(t_s) + clock_.stamped_ns(t, random) - clock_.sensor_ns(t);
  }
  [[nodiscard]] RigTime received(double t_s, Random& random) const {
    return clock_.received(context_.rig_time(t_s), random);
  }

 private:
  [[nodiscard]] std::int64_t epoch_shift_ns(double t_s) const {
    if (!own_epoch_) return 0;
    const LidarBoot boot = faults_.boot(t_s);
    if (boot.number == 0) return uptime_shift_ns(context_.start);
    return -clock_.sensor_ns(context_.rig_time(boot.down_s));
  }

  SensorClock clock_;
  bool own_epoch_;
  const Context& context_;
  const LidarFaults& faults_;
};

}  // namespace lxd::sim
