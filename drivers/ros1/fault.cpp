// SPDX-License-Identifier: Apache-2.0
#include "drivers/ros1/fault.hpp"

#include <array>

namespace lxd {

const char* name_of(Ros1Fault fault) {
  static constexpr std::array<const char*, 11> kNames{
      "none",           "truncated",        "trailing_bytes", "big_endian",       "bad_layout",
      "no_coordinates", "unknown_datatype", "bad_time",       "unknown_encoding", "non_finite",
      "empty"};
  return kNames.at(static_cast<std::size_t>(fault));
}

}  // namespace lxd
