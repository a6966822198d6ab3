// SPDX-License-Identifier: Apache-2.0
// A finished run taken through the loop finder once more, sub-mesh by sub-mesh, and its loops held against the truth.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "backend/loops/loop_finder.hpp"
#include "rt/result.hpp"
#include "tools/loops/places.hpp"

namespace lxd {

struct TrialLoop {
  LoopMeasurement loop;
  double error_m = 0, error_rad = 0;
  double nees = 0;  // of six dimensions, by the loop's own covariance
};

struct FinderTrial {
  std::vector<TrialLoop> loops;
  std::size_t false_loops = 0;               // wrong by more than half a metre or 3 degrees
  std::size_t revisits = 0, found = 0;       // stretches of way that were driven before; those with a true loop
  double add_ms_mean = 0, add_ms_max = 0;    // a sub-mesh
  double find_ms_mean = 0, find_ms_max = 0;  // a call
  std::size_t bytes = 0;
  LoopCounters counters;
};

struct TrialConfig {
  LoopFinderConfig finder;
  PlaceConfig places;
  double same_m = 4;      // nearer is a revisit
  double stretch_m = 10;  // of way that counts as one revisit
};

Result<FinderTrial> try_finder(const std::filesystem::path& run, const std::filesystem::path& truth,
                               const TrialConfig& config);

}  // namespace lxd
