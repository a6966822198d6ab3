// SPDX-License-Identifier: Apache-2.0
#include "board/run_folder.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace lxd {
namespace {

namespace fs = std::filesystem;

constexpr std::array kAllFiles{run_files::kOdometry,   run_files::kCovariance, run_files::kInnovation,
                               run_files::kTrajectory, run_files::kMesh,       run_files::kCloud,
                               run_files::kArchive,    run_files::kRig,        run_files::kReport,
                               run_files::kOverview,   run_files::kErrorPlots, run_files::kSensorPlots};
// What the writers of these files leave beside them when a run is cut off.
constexpr std::array<std::string_view, 4> kTails{"", ".part", "-wal", "-shm"};

// A recording may hold a path of its own; no recording holds a map's archive.
bool is_run(const fs::path& path) {
  return fs::is_regular_file(path / run_files::kOdometry) && fs::exists(path / run_files::kArchive);
}

void remove_run_files(const fs::path& path) {
  for (const std::string_view name : kAllFiles) {
    for (const std::string_view tail : kTails) fs::remove(path / fmt::format("{}{}", name, tail));
  }
}

Status prepare(const fs::path& path) {
  if (fs::exists(path) && !fs::is_directory(path)) {
    return Error{fmt::format("{}: found a file, wanted a folder for the run", path.string())};
  }
  fs::create_directories(path);
  if (fs::is_empty(path)) return success();
  if (!is_run(path)) {
    return Error{
        fmt::format("{}: found a folder that holds something other than a run, wanted a new or empty one "
                    "or an earlier run",
                    path.string())};
  }
  remove_run_files(path);
  return success();
}

}  // namespace

Result<RunFolder> RunFolder::create(const fs::path& path) {
  try {
    const Status prepared = prepare(path);
    if (!prepared) return prepared.error();
  } catch (const fs::filesystem_error& e) {
    const fs::path& at = e.path1().empty() ? path : e.path1();
    return Error{fmt::format("{}: cannot be made anew: {}", at.string(), e.code().message())};
  }
  return RunFolder(path);
}

Result<RunFolder> RunFolder::open(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return Error{fmt::format("{}: found no folder, wanted a run's", path.string())};
  if (!is_run(path)) {
    return Error{fmt::format("{}: found no {} and {}, wanted a run's folder", path.string(), run_files::kOdometry,
                             run_files::kArchive)};
  }
  return RunFolder(path);
}

Result<LineFile> LineFile::create(const fs::path& path) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  if (!out) return Error{fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))};
  return LineFile(path, std::move(out));
}

Status LineFile::append(std::string_view lines) {
  if (waiting_.size() + lines.size() <= kWaitingMax) waiting_ += lines;
  out_ << waiting_ << std::flush;
  if (!out_) {
    Error error{fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno))};
    go_back();
    return error;
  }
  size_ += waiting_.size();
  waiting_.clear();
  return success();
}

// Half a line may have had room.
void LineFile::go_back() {
  std::error_code ignored;
  out_.clear();
  out_.close();
  fs::resize_file(path_, size_, ignored);
  out_.open(path_, std::ios::binary | std::ios::app);
}

Status write_text(const fs::path& path, std::string_view text) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text << std::flush;
  if (!out) return Error{fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))};
  return success();
}

}  // namespace lxd
