// SPDX-License-Identifier: Apache-2.0
// Where recorded data lies: what the clone carries, and what it does not.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace lxd::test {

// See the README of each folder of tests/data.
inline std::filesystem::path clone_data(const std::string& name) { return std::filesystem::path(LXD_TEST_DATA) / name; }

// None when LXD_SHARED_DATA is not set or has no such file.
inline std::optional<std::filesystem::path> shared_data(const std::string& name) {
  const char* const root = std::getenv("LXD_SHARED_DATA");
  if (root == nullptr) return std::nullopt;
  const auto path = std::filesystem::path(root) / name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

}  // namespace lxd::test
