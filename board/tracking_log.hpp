// SPDX-License-Identifier: Apache-2.0
// When a sensor stopped taking part in the pose, and when it did again: the report's `degraded` and `updates`.
#pragma once

#include <optional>
#include <string>

#include "board/report.hpp"
#include "board/sensor_set.hpp"
#include "estimator/sweep_outcome.hpp"

namespace lxd {

class TrackingLog {
 public:
  explicit TrackingLog(const SensorSet& sensors) : sensors_(sensors), working_(all_of(sensors)) {}

  // Of each sweep that was taken, in order; the first of a map has nothing to be tracked against.
  void note(const SweepOutcome& outcome, Report& report);
  // The next sweep is the first of a map.
  void begin_again() { first_ = true; }

 private:
  // Those that the filter takes; fixes of GNSS are the back-end's.
  static std::string all_of(SensorSet sensors);
  [[nodiscard]] std::string working(const SweepOutcome& outcome) const;
  void change(const std::string& now, RigTime t, Report& report);

  SensorSet sensors_;
  std::string working_;          // sensors that made the last pose
  std::optional<RigTime> last_;  // pose
  bool first_ = true;
};

}  // namespace lxd
