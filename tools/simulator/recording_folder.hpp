// SPDX-License-Identifier: Apache-2.0
// The folder of a recording under way: written as `<OUT>.part.` with six more letters, renamed when whole, and marked
// as unfinished until then, so that half a recording never looks like one, whoever is killed.
#pragma once

#include <cstdint>
#include <filesystem>

#include "rt/result.hpp"

namespace lxd::sim {

// In every simulated recording, and in nothing else: what it is and what was done to it.
inline constexpr const char* kSimulationFile = "simulation.json";

class RecordingFolder {
 public:
  // Errors: `out` exists and is neither empty nor an earlier simulation's; it cannot be made or written; the disk has
  // less than `wanted_bytes` left.
  static Result<RecordingFolder> create(const std::filesystem::path& out, std::uint64_t wanted_bytes);
  RecordingFolder(RecordingFolder&& other) noexcept;
  RecordingFolder& operator=(RecordingFolder&&) = delete;
  ~RecordingFolder();  // removes what was not committed

  [[nodiscard]] const std::filesystem::path& path() const { return part_; }  // where to write
  Status commit();

 private:
  RecordingFolder(std::filesystem::path out, std::filesystem::path part)
      : out_(std::move(out)), part_(std::move(part)) {}
  std::filesystem::path out_, part_;
};

}  // namespace lxd::sim
