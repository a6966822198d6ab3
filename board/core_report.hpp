// SPDX-License-Identifier: Apache-2.0
// What the core says of itself in a run's report.
#pragma once

#include "board/report.hpp"
#include "board/slam_core.hpp"

namespace lxd {

// As the report's `dropped` names it.
const char* name_of(SweepRejection rejection);

// How full the pools were at most, so far. After each sweep.
void count_pools(SlamCore& core, Report& report);

// What the filter found of its sensors. In the end.
void add_calibration(const Odometry& odometry, const Star& star, Report& report);

}  // namespace lxd
