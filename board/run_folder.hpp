// SPDX-License-Identifier: Apache-2.0
// The folder of a run: which files it holds, and that nothing else is ever overwritten.
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "rt/result.hpp"

namespace lxd {

namespace run_files {
inline constexpr std::string_view kOdometry = "odometry.tum";               // the filter's path, as it was estimated
inline constexpr std::string_view kCovariance = "odometry_covariance.txt";  // of the same poses
inline constexpr std::string_view kInnovation = "odometry_innovation.txt";  // of the updates that made them
inline constexpr std::string_view kTrajectory = "trajectory.tum";           // after the back-end
inline constexpr std::string_view kMesh = "mesh.ply";
inline constexpr std::string_view kCloud = "cloud.ply";
inline constexpr std::string_view kArchive = "map.db";
inline constexpr std::string_view kRig = "rig.yaml";
inline constexpr std::string_view kReport = "report.json";
inline constexpr std::string_view kOverview = "overview.png";
// What `evaluate` and the recording's plots leave beside it: of no worth when the run is replaced.
inline constexpr std::string_view kErrorPlots = "errors.png";
inline constexpr std::string_view kSensorPlots = "sensors.png";
}  // namespace run_files

class RunFolder {
 public:
  // Makes the folder, or empties an earlier run's of the files that a run writes (others stay). A folder that holds
  // something but is not a run's is refused: it may be a recording.
  static Result<RunFolder> create(const std::filesystem::path& path);

  // An existing run, for export. Error: not a run's folder.
  static Result<RunFolder> open(const std::filesystem::path& path);

  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

// A text file that grows line by line; each line is with the operating system when append() returns, so that whatever
// ends the run, the lines so far are there.
class LineFile {
 public:
  static Result<LineFile> create(const std::filesystem::path& path);
  // Whole lines, with their ends. Error: the disk is full, ... Then the file ends with its last whole line, and what
  // came since waits for the next call, as far as kWaitingMax goes.
  Status append(std::string_view lines);

  static constexpr std::size_t kWaitingMax = std::size_t{1} << 20U;  // bytes: some hours of a path

 private:
  LineFile(std::filesystem::path path, std::ofstream out) : path_(std::move(path)), out_(std::move(out)) {}
  void go_back();

  std::filesystem::path path_;
  std::ofstream out_;
  std::uintmax_t size_ = 0;  // of what is written
  std::string waiting_;
};

// A whole small file at once.
Status write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace lxd
