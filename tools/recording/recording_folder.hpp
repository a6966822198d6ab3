// SPDX-License-Identifier: Apache-2.0
// The folder of a recording under way: written as `<OUT>.part.` with six more letters, renamed when whole, and marked
// as unfinished until then, so that half a recording never looks like one, whoever is killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "rt/result.hpp"

namespace lxd {

// What a writer may replace: a folder of its own kind and nothing besides.
struct RecordingKind {
  const char* name;                           // in messages: "a simulated recording"
  std::string_view mark;                      // a file that every one of them has, and nothing else
  std::span<const std::string_view> entries;  // everything else that the writer writes into its folder
};

class RecordingFolder {
 public:
  // Errors: `out` exists and is neither empty nor an earlier one of its kind; it cannot be made or written; the disk
  // has less than `wanted_bytes` left.
  static Result<RecordingFolder> create(const std::filesystem::path& out, std::uint64_t wanted_bytes,
                                        const RecordingKind& kind);
  RecordingFolder(RecordingFolder&& other) noexcept;
  RecordingFolder& operator=(RecordingFolder&&) = delete;
  ~RecordingFolder();  // removes what was not committed

  [[nodiscard]] const std::filesystem::path& path() const { return part_; }  // where to write
  Status commit();

 private:
  RecordingFolder(std::filesystem::path out, std::filesystem::path part, const RecordingKind& kind)
      : out_(std::move(out)), part_(std::move(part)), kind_(kind) {}
  std::filesystem::path out_, part_;
  RecordingKind kind_;
};

}  // namespace lxd
