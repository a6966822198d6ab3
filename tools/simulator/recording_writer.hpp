// SPDX-License-Identifier: Apache-2.0
// The files of a recording, one sensor after the other; each sensor spreads its own work over the threads.
#pragma once

#include <atomic>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "tools/simulator/context.hpp"
#include "tools/simulator/simulation.hpp"

namespace lxd::sim {

// What can be known before the work: stamps before a clock's zero or beyond what packets hold, a line that is too slow,
// a lens that folds.
Status check_sensors(const Context& context, const Scenario& scenario);

class RecordingWriter {
 public:
  RecordingWriter(const Context& context, const SimulateRequest& request, std::filesystem::path folder)
      : context_(context), request_(request), folder_(std::move(folder)) {}

  Status write(const SimulateObserver& observe, const std::atomic<bool>& stop);

 private:
  Status write_lidar(const LidarConfig& config, const SimulateObserver& observe, const std::atomic<bool>& stop);
  Status write_truth();
  Status write_simulation_file();

  const Context context_;
  const SimulateRequest& request_;
  std::filesystem::path folder_;
  nlohmann::ordered_json counts_;  // by sensor: what was sent, and what faults did to it
};

}  // namespace lxd::sim
