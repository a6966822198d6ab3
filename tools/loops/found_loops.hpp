// SPDX-License-Identifier: Apache-2.0
// The loops that a finished run says it found, by surfaces and by sight, held against the truth.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rt/result.hpp"

namespace lxd {

struct FoundLoop {
  double from_s = 0, to_s = 0;  // key frames
  std::string by;               // "surfaces", "sight"
  bool accepted = false;        // by the graph
  double sigma_m = 0;           // as it claims, the worst axis
  double error_m = 0, error_rad = 0;
  [[nodiscard]] bool is_false() const;  // wrong by more than half a metre or 3 degrees
};

// RUN/report.json and a TUM file of the truth, of the body (an IMU that is the reference). Those of instants that the
// truth does not have are left out.
Result<std::vector<FoundLoop>> judge_found_loops(const std::filesystem::path& run, const std::filesystem::path& truth);

}  // namespace lxd
