// SPDX-License-Identifier: Apache-2.0
// See ouster_metadata_file.hpp.
#include "drivers/replay/ouster_metadata_file.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace lxd {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kBiggestMetadata_bytes = 8U << 20U;  // the samples have up to 50 kB

std::vector<fs::path> json_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ".json") files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// The file with the longest stem that `name` begins with; empty when there is none.
fs::path longest_prefix(const std::vector<fs::path>& files, const std::string& name) {
  fs::path best;
  for (const fs::path& file : files) {
    const std::string stem = file.stem().string();
    if (name.starts_with(stem) && stem.size() > best.stem().string().size()) best = file;
  }
  return best;
}

}  // namespace

Result<fs::path> find_ouster_metadata(const fs::path& pcap) {
  const fs::path folder = pcap.has_parent_path() ? pcap.parent_path() : fs::path(".");
  const std::string name = pcap.stem().string();
  for (const char* suffix : {".json", "_0.json"}) {
    const fs::path beside = folder / (name + suffix);
    if (fs::exists(beside)) return beside;
  }
  const std::vector<fs::path> files = json_files(folder);
  const fs::path prefix = longest_prefix(files, name);
  if (!prefix.empty()) return prefix;
  if (files.size() == 1) return files.front();
  std::string found;
  for (const fs::path& file : files) found += "\n  " + file.filename().string();
  return Error{
      fmt::format("{}: found {} .json files beside it and none of its name, wanted the sensor's metadata as "
                  "{}.json{}",
                  pcap.string(), files.size(), name, found)};
}

Result<OusterMetadata> read_ouster_metadata(const fs::path& json) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(json, error);
  std::ifstream file(json, std::ios::binary);
  if (error || !file)
    return Error{fmt::format("{}: cannot be read, wanted an Ouster sensor's metadata", json.string())};
  if (bytes > kBiggestMetadata_bytes) {
    return Error{fmt::format("{}: found {} bytes, wanted at most {}", json.string(), bytes, kBiggestMetadata_bytes)};
  }
  std::string text(static_cast<std::size_t>(bytes), '\0');
  file.read(text.data(), static_cast<std::streamsize>(bytes));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return parse_ouster_metadata(text, json.string());
}

}  // namespace lxd
