// SPDX-License-Identifier: Apache-2.0
// A LiDAR's sweeps as a generic folder has them: float32 x y z intensity t_offset_s a point, not deskewed, and
// times.txt with the time of each sweep's first shot.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

struct WrittenScan {
  RigTime begin;
  std::vector<float> values;  // five a point

  void push(float x_m, float y_m, float z_m, float intensity, double offset_s) {
    values.insert(values.end(), {x_m, y_m, z_m, intensity, static_cast<float>(offset_s)});
  }
};

class ScanFolderWriter {
 public:
  static Result<ScanFolderWriter> create(const std::filesystem::path& folder);

  Status write(const WrittenScan& scan);
  Status close();

 private:
  explicit ScanFolderWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::filesystem::path folder_;
  std::uint64_t scans_ = 0;
  std::string times_;
};

}  // namespace lxd
