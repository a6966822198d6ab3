// SPDX-License-Identifier: Apache-2.0
// Recordings made on the spot for tests: scan files, time files; and where recorded data lies.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/replay/open.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::replay_test {

inline void write_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  write_bytes(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

inline void write_floats(const std::filesystem::path& path, const std::vector<float>& floats) {
  write_bytes(path, {reinterpret_cast<const std::uint8_t*>(floats.data()), floats.size() * sizeof(float)});
}

inline std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// A sweep that owns its storage.
struct OwnedSweep {
  std::vector<LidarPoint> points;
  Sweep header;  // its storage is not to be used
};

inline std::vector<OwnedSweep> read_all(SweepSource& source, std::size_t capacity = 200000) {
  std::vector<LidarPoint> storage(capacity);
  std::vector<OwnedSweep> sweeps;
  for (;;) {
    Sweep sweep;
    sweep.storage = storage;
    const auto more = source.next(sweep);
    if (!more || !*more) break;
    const auto points = sweep.points();
    sweeps.push_back({{points.begin(), points.end()}, sweep});
  }
  return sweeps;
}

inline std::unique_ptr<SweepSource> must_open(const std::filesystem::path& path, const ReplayOptions& options = {}) {
  auto opened = open_recording(path, options);
  if (!opened) {
    ADD_FAILURE() << opened.error().message;
    return nullptr;
  }
  return std::move(*opened);
}

// The message of a recording that must not open.
inline std::string open_error(const std::filesystem::path& path) {
  const auto opened = open_recording(path, {});
  return opened ? "opened as " + (*opened)->kind() : opened.error().message;
}

// Captures that the clone carries; see tests/data/ouster/README.md.
inline std::filesystem::path clone_ouster() { return test::clone_data("ouster"); }

// Captures that it does not: none when LXD_SHARED_DATA is not set or has no such file.
inline std::optional<std::filesystem::path> shared_ouster(const std::string& name) {
  return test::shared_data("ouster/" + name);
}

using Counts = std::map<std::string, std::uint64_t>;

}  // namespace lxd::replay_test
