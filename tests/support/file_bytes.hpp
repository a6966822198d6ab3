// SPDX-License-Identifier: Apache-2.0
// What a file's bytes say.
#pragma once

#include <cstring>
#include <string>

namespace lxd::test {

// In this machine's byte order, which is the files' (little-endian).
template <typename T>
T number_at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

}  // namespace lxd::test
