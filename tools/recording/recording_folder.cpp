// SPDX-License-Identifier: Apache-2.0
// See recording_folder.hpp.
#include "tools/recording/recording_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "board/run_folder.hpp"
#include "drivers/replay/unfinished_recording.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

constexpr double kBytesPerMebibyte = 1024.0 * 1024.0;

Error failed(const fs::path& path, const std::error_code& cause) {
  return Error{fmt::format("{}: {}", path.string(), cause.message())};
}

bool is_own(const fs::path& entry, const RecordingKind& kind) {
  const std::string name = entry.filename().string();
  return name == kind.mark || std::ranges::find(kind.entries, name) != kind.entries.end();
}

// Nothing, or a recording of this kind and nothing besides.
bool holds_own_only(const fs::path& folder, const RecordingKind& kind) {
  std::error_code error;
  bool any = false;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!is_own(entry->path(), kind)) return false;
    any = true;
  }
  return !error && (!any || fs::exists(folder / kind.mark, error));
}

// What stands at `out` may be replaced: nothing, an empty folder, an earlier one of its kind.
Status check_replaceable(const fs::path& out, const RecordingKind& kind) {
  std::error_code error;
  const fs::file_status found = fs::status(out, error);
  if (!fs::exists(found)) return success();
  if (!fs::is_directory(found)) return Error{fmt::format("{}: found a file, wanted a folder to make", out.string())};
  if (holds_own_only(out, kind)) return success();
  return Error{
      fmt::format("{}: found a folder that holds something else than {}; it stays as it is", out.string(), kind.name)};
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

Result<RecordingFolder> RecordingFolder::create(const fs::path& out, std::uint64_t wanted_bytes,
                                                const RecordingKind& kind) {
  const fs::path clean = out.has_filename() ? out : out.parent_path();
  const Status replaceable = check_replaceable(clean, kind);
  if (!replaceable) return replaceable.error();
  std::error_code error;
  if (clean.has_parent_path()) fs::create_directories(clean.parent_path(), error);
  if (error) return failed(clean.parent_path(), error);
  std::string part = clean.string() + ".part.XXXXXX";  // one of its own, should two write to the same place
  if (mkdtemp(part.data()) == nullptr) return failed(clean, std::error_code(errno, std::generic_category()));
  fs::permissions(part,
                  fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read |
                      fs::perms::others_exec,
                  error);
  RecordingFolder folder(clean, part, kind);
  const Status marked = write_text(folder.path() / kUnfinishedMark, kUnfinishedText);
  if (!marked) return marked.error();
  const Status fits = check_space(part, wanted_bytes);
  if (!fits) return fits.error();
  return folder;
}

RecordingFolder::RecordingFolder(RecordingFolder&& other) noexcept
    : out_(std::exchange(other.out_, {})), part_(std::exchange(other.part_, {})), kind_(other.kind_) {}

RecordingFolder::~RecordingFolder() {
  std::error_code ignored;
  if (!part_.empty()) fs::remove_all(part_, ignored);
}

Status RecordingFolder::commit() {
  const Status replaceable = check_replaceable(out_, kind_);  // again: the work took its time
  if (!replaceable) return replaceable;
  std::error_code error;
  fs::remove(part_ / kUnfinishedMark, error);
  if (error) return failed(part_ / kUnfinishedMark, error);
  fs::remove_all(out_, error);
  if (!error) fs::rename(part_, out_, error);
  if (error) return failed(out_, error);
  part_.clear();
  return success();
}

}  // namespace lxd
