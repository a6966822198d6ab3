// SPDX-License-Identifier: Apache-2.0
// Rejections by cause, as every source reports them.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace lxd {

using Rejections = std::map<std::string, std::uint64_t>;

// Causes that never happened stay out of the map.
inline void count_rejected(Rejections& rejections, const char* cause, std::uint64_t times = 1) {
  if (times > 0) rejections[cause] += times;
}

}  // namespace lxd
