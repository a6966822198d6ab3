// SPDX-License-Identifier: Apache-2.0
// A small output file in one go, with every failure told.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <span>

#include <fmt/format.h>

#include "rt/result.hpp"

namespace lxd {

inline Status write_whole_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  const bool written = file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int cause = errno;
  const bool closed = file != nullptr && std::fclose(file) == 0;
  if (written && closed) return success();
  return Error{fmt::format("{}: cannot be written: {}", path.string(), std::strerror(written ? errno : cause))};
}

}  // namespace lxd
