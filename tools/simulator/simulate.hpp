// SPDX-License-Identifier: Apache-2.0
// A scenario into a recording: what `lxd-slam simulate` and the tests call.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rt/result.hpp"
#include "tools/simulator/faults.hpp"
#include "tools/simulator/scenario.hpp"

namespace lxd::sim {

struct SimulateRequest {
  Scenario scenario;
  std::uint64_t seed = 0;
  std::vector<std::string> faults;  // as --fault takes them
  std::filesystem::path out;
  bool generic = false;  // a generic folder instead of the rig recording
  unsigned threads = 2;
};

// The sensor under way, and the part of it that is done, 0 .. 1.
using SimulateObserver = std::function<void(std::string_view sensor, double part)>;

struct SimulateSummary {
  std::uint64_t bytes = 0;  // of the whole recording
  double duration_s = 0;
  double path_m = 0;  // length of the true path
};

// The faults that the scenario's sensors know.
std::vector<KnownFault> faults_of(const Scenario& scenario);

class Simulation {
 public:
  // World, motion, faults and folder. Errors: a fault, a world's file, a motion that does not fit its world, a folder that
  // cannot be written, a disk without room. Nothing is left at `out`.
  static Result<std::unique_ptr<Simulation>> prepare(SimulateRequest request);

  // Writes the recording. An error (writing, `stop`) leaves nothing at `out` either. Once.
  Result<SimulateSummary> run(const SimulateObserver& observe, const std::atomic<bool>& stop);
};

}  // namespace lxd::sim
