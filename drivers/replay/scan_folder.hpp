// SPDX-License-Identifier: Apache-2.0
// A folder of numbered scan files (000000.bin, 000001.bin, ...), each a plain array of floats.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "drivers/replay/rejections.hpp"
#include "rt/result.hpp"

namespace lxd {

struct ScanFile {
  std::uint32_t number = 0;  // of its name; the line of its stamp, from 0
  std::filesystem::path path;
};

// The folder's scan files by number. Errors: no such folder, or not one scan file in it.
Result<std::vector<ScanFile>> list_scan_files(const std::filesystem::path& folder);
bool has_scan_files(const std::filesystem::path& folder);

// Reads scan files one after the other into one buffer.
class ScanFileReader {
 public:
  // The file's whole points, floats_per_point floats each, valid until the next read. None, and counted, when the file
  // cannot be read ("unreadable_file") or is absurdly big ("oversized_file"); a file that ends within a point is
  // counted
  // ("truncated_file") and read up to there.
  std::optional<std::span<const float>> read(const std::filesystem::path& path, std::size_t floats_per_point,
                                             Rejections& rejected);

 private:
  std::vector<float> buffer_;
};

}  // namespace lxd
