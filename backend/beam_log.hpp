// SPDX-License-Identifier: Apache-2.0
// The beams of one sub-mesh, on the disk: each return with the place that it was seen from. Where the sub-mesh is added
// to for long they are kept of fewer and fewer sweeps. Low-priority thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "backend/scratch_file.hpp"
#include "mapping/beam.hpp"
#include "rt/result.hpp"

namespace lxd {

// Of one sweep, world.
struct BeamSweep {
  struct Return {
    Eigen::Vector3d p_m;
    float to_come;  // share of the sweep's span that was still to come then, 0..1
  };
  Eigen::Vector3d lidar_then_m, lidar_m;  // when the span began, and ended
  std::span<const Return> returns;
};

class BeamLog {
 public:
  static constexpr float kReach_m = 130;  // farther returns are left out
  // After so many beams every second sweep is kept, after as many more every fourth, and so on: 4 MiB each.
  static constexpr std::uint64_t kBeamsAStride = std::uint64_t{1} << 19;

  // Its file has no name, on the folder's disk. Error: folder and the system's cause.
  static Result<BeamLog> create(const std::filesystem::path& folder);

  // Empty, for another sub-mesh.
  void clear();
  // Error: the disk is full, ...: the sweep is not in the log, the next may be.
  Status add(const BeamSweep& sweep);
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  friend class BeamReader;
  explicit BeamLog(ScratchFile file) : file_(std::move(file)) {}

  ScratchFile file_;
  std::uint64_t end_ = 0, count_ = 0;  // bytes, beams
  std::uint64_t stride_ = 1, passed_ = 0;
  std::vector<std::byte> record_;  // reused
};

// Reads a log once, sweep by sweep. The log outlives it and is not added to meanwhile.
class BeamReader final : public BeamSource {
 public:
  explicit BeamReader(const BeamLog& log) : log_(&log) {}

  // Where they went to within 4 mm. None: that was all, or reading failed.
  std::span<const Beam> next() override;
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  const BeamLog* log_;
  std::uint64_t at_ = 0;
  std::vector<std::byte> record_;
  std::vector<Beam> beams_;
  Status status_ = success();
};

}  // namespace lxd
