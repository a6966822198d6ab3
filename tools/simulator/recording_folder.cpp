// SPDX-License-Identifier: Apache-2.0
// See recording_folder.hpp.
#include "tools/simulator/recording_folder.hpp"

#include <utility>

#include <fmt/format.h>

namespace lxd::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kBytesPerMebibyte = 1024.0 * 1024.0;

Error failed(const fs::path& path, const std::error_code& cause) {
  return Error{fmt::format("{}: {}", path.string(), cause.message())};
}

// What stands at `out` may be replaced: nothing, an empty folder, an earlier simulation.
Status check_replaceable(const fs::path& out) {
  std::error_code error;
  const fs::file_status found = fs::status(out, error);
  if (!fs::exists(found)) return success();
  if (!fs::is_directory(found)) return Error{fmt::format("{}: found a file, wanted a folder to make", out.string())};
  if (fs::exists(out / kSimulationFile, error) || fs::is_empty(out, error)) return success();
  return Error{fmt::format("{}: found a folder that holds something else than a simulated recording; it stays as it is",
                           out.string())};
}

Status check_space(const fs::path& folder, std::uint64_t wanted_bytes) {
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (error || space.available >= wanted_bytes) return success();
  return Error{fmt::format("{}: found {:.0f} MiB of free space, wanted about {:.0f} MiB", folder.string(),
                           static_cast<double>(space.available) / kBytesPerMebibyte,
                           static_cast<double>(wanted_bytes) / kBytesPerMebibyte)};
}

}  // namespace

Result<RecordingFolder> RecordingFolder::create(const fs::path& out, std::uint64_t wanted_bytes) {
  const fs::path clean = out.has_filename() ? out : out.parent_path();
  const Status replaceable = check_replaceable(clean);
  if (!replaceable) return replaceable.error();
  fs::path part = clean;
  part += ".part";
  std::error_code error;
  fs::remove_all(part, error);
  if (!error) fs::create_directories(part, error);
  if (error) return failed(part, error);
  RecordingFolder folder(clean, part);
  const Status fits = check_space(part, wanted_bytes);
  if (!fits) return fits.error();
  return folder;
}

RecordingFolder::RecordingFolder(RecordingFolder&& other) noexcept
    : out_(std::exchange(other.out_, {})), part_(std::exchange(other.part_, {})) {}

RecordingFolder::~RecordingFolder() {
  std::error_code ignored;
  if (!part_.empty()) fs::remove_all(part_, ignored);
}

Status RecordingFolder::commit() {
  std::error_code error;
  fs::remove_all(out_, error);
  if (!error) fs::rename(part_, out_, error);
  if (error) return failed(out_, error);
  part_.clear();
  return success();
}

}  // namespace lxd::sim
