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
#include "tools/recording/recording_folder.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/scenario.hpp"
#include "tools/simulator/world/scene.hpp"

namespace lxd::sim {

struct SimulateRequest {
  Scenario scenario;
  std::uint64_t seed = 0;
  std::vector<std::string> faults;  // as --fault takes them
  std::filesystem::path out;
  bool generic = false;  // a generic folder instead of the rig recording
  unsigned threads = 2;
};

// What is being written, and the part of it that is done, 0 .. 1.
using SimulateObserver = std::function<void(std::string_view what, double part)>;

struct SimulateSummary {
  std::uint64_t bytes = 0;  // of the whole recording
  double duration_s = 0;
  double path_m = 0;               // length of the true path
  std::vector<std::string> files;  // of the recording's folder, in the order of their names; folders with a slash
};

// The faults that the scenario's sensors know. A generic folder has no packets, clocks and pulses that could be wrong.
std::vector<KnownFault> faults_of(const Scenario& scenario, bool generic);

class Simulation {
 public:
  // World, motion, faults and folder. Errors: a fault, a world's file, a motion that does not fit its world, a sensor
  // that cannot work so, a folder that cannot be written, a disk without room. Nothing is left at `out`.
  static Result<std::unique_ptr<Simulation>> prepare(SimulateRequest request);

  // Writes the recording. An error (writing, `stop`) leaves nothing at `out` either. Once.
  Result<SimulateSummary> run(const SimulateObserver& observe, const std::atomic<bool>& stop);

 private:
  Simulation(SimulateRequest request, World world, FaultPlan faults);
  Status make_path();
  [[nodiscard]] Status check_path() const;
  [[nodiscard]] Context context() const;
  [[nodiscard]] double path_m() const;

  SimulateRequest request_;
  World world_;
  Scene scene_;
  FaultPlan faults_;
  std::unique_ptr<const Trajectory> motion_;
  std::unique_ptr<RecordingFolder> folder_;
};

}  // namespace lxd::sim
