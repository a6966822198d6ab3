// SPDX-License-Identifier: Apache-2.0
// When the sweeps stopped holding the pose, and when they held it again: the report's `degraded` and `updates`.
#pragma once

#include <string>

#include "board/report.hpp"
#include "board/sensor_set.hpp"
#include "estimator/sweep_outcome.hpp"

namespace lxd {

class TrackingLog {
 public:
  explicit TrackingLog(const SensorSet& sensors) : sensors_(text_of(sensors)) {}

  // Of each sweep that was taken, in order; the first of a map has nothing to be tracked against.
  void note(const SweepOutcome& outcome, Report& report);
  // The next sweep is the first of a map.
  void begin_again() { first_ = true; }

 private:
  // What carries the pose when no sweep does: its own motion.
  static constexpr const char* kPrediction = "none";

  std::string sensors_;
  bool first_ = true;
  bool tracked_ = true;
};

}  // namespace lxd
