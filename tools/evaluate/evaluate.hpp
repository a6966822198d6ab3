// SPDX-License-Identifier: Apache-2.0
// `lxd-slam evaluate`: an estimated path (and mesh) against the truth.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "rt/result.hpp"
#include "rt/time.hpp"
#include "tools/evaluate/mesh_errors.hpp"
#include "tools/evaluate/report.hpp"

namespace lxd {

struct EvaluateOptions {
  std::filesystem::path estimate;  // TUM
  std::filesystem::path truth;     // TUM, of the same frame of the rig
  // 22 columns; without it, `<stem of estimate>_covariance.txt` beside the estimate is taken when it is there.
  std::optional<std::filesystem::path> covariance;
  std::optional<std::filesystem::path> mesh;   // PLY in the estimate's map frame
  std::optional<std::filesystem::path> world;  // PLY in truth's world frame; wanted with `mesh`
  // Whose LiDARs saw the world; without it, everything within mesh_errors.view_range_m and in line of sight counts.
  std::optional<std::filesystem::path> rig;
  Duration truth_gap_max = Duration::from_ns(kNanosPerSecond);  // truth is not interpolated over a longer gap
  MeshErrorOptions mesh_errors;
};

// Error: a file that cannot be read (file, line, what), mesh without world or the reverse, a rig without mesh or
// without orientations of truth, no estimate within truth's time.
Result<EvaluationReport> evaluate(const EvaluateOptions& options);

std::string to_table(const EvaluationReport& report);    // for people, ends with a line feed
nlohmann::json to_json(const EvaluationReport& report);  // for programs; metres, degrees; README lists the keys

}  // namespace lxd
