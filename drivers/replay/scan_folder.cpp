// SPDX-License-Identifier: Apache-2.0
// See scan_folder.hpp.
#include "drivers/replay/scan_folder.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <fstream>
#include <string>

#include <fmt/format.h>

namespace lxd {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "scan files hold little-endian floats");

constexpr std::uintmax_t kBiggestScan_bytes = 256U << 20U;  // some 16 million points; no sensor sends that in a turn

std::optional<std::uint32_t> scan_number(const fs::path& path) {
  if (path.extension() != ".bin") return std::nullopt;
  const std::string stem = path.stem().string();
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (error != std::errc() || end != stem.data() + stem.size()) return std::nullopt;
  return number;
}

std::vector<ScanFile> find_scan_files(const fs::path& folder) {
  std::vector<ScanFile> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (const auto number = scan_number(entry->path())) files.push_back({*number, entry->path()});
  }
  std::sort(files.begin(), files.end(), [](const ScanFile& a, const ScanFile& b) {
    return a.number != b.number ? a.number < b.number : a.path < b.path;
  });
  return files;
}

}  // namespace

Result<std::vector<ScanFile>> list_scan_files(const fs::path& folder) {
  std::vector<ScanFile> files = find_scan_files(folder);
  if (files.empty()) {
    return Error{fmt::format("{}: found no scan file, wanted 000000.bin and so on", folder.string())};
  }
  return files;
}

bool has_scan_files(const fs::path& folder) { return !find_scan_files(folder).empty(); }

std::optional<std::span<const float>> ScanFileReader::read(const fs::path& path, std::size_t floats_per_point,
                                                           Rejections& rejected) {
  const std::size_t point_bytes = floats_per_point * sizeof(float);
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) {
    count_rejected(rejected, "unreadable_file");
    return std::nullopt;
  }
  if (bytes > kBiggestScan_bytes) {
    count_rejected(rejected, "oversized_file");
    return std::nullopt;
  }
  const auto floats = static_cast<std::size_t>(bytes / point_bytes) * floats_per_point;
  if (bytes % point_bytes != 0) count_rejected(rejected, "truncated_file");
  if (buffer_.size() < floats) buffer_.resize(floats);
  file.read(reinterpret_cast<char*>(buffer_.data()), static_cast<std::streamsize>(floats * sizeof(float)));
  const auto points_read = static_cast<std::size_t>(file.gcount()) / point_bytes;  // the file may have shrunk meanwhile
  return std::span<const float>(buffer_).first(points_read * floats_per_point);
}

}  // namespace lxd
