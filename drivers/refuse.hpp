// SPDX-License-Identifier: Apache-2.0
// How a parser says no: one count more, and false.
#pragma once

#include <cstdint>

namespace lxd {

[[nodiscard]] inline bool refuse(std::uint64_t& count) {
  ++count;
  return false;
}

}  // namespace lxd
