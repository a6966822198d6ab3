// SPDX-License-Identifier: Apache-2.0
// Rejections by cause, as every source reports them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>

namespace lxd {

using Rejections = std::map<std::string, std::uint64_t>;

// Causes that never happened stay out of the map.
inline void count_rejected(Rejections& rejections, const char* cause, std::uint64_t times = 1) {
  if (times > 0) rejections[cause] += times;
}

// Numbers that a part counts for itself, and that only grow, under their names.
inline void set_rejected(Rejections& rejections, std::initializer_list<std::pair<const char*, std::uint64_t>> counts) {
  for (const auto& [cause, count] : counts) {
    if (count > 0) rejections[cause] = count;
  }
}

}  // namespace lxd
