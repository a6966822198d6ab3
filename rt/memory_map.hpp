// SPDX-License-Identifier: Apache-2.0
// The address space of this process as the kernel lists it in /proc/self/maps (proc(5)).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rt/result.hpp"

namespace lxd {

struct Mapping {
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
  bool readable = false;
  bool writable = false;
  bool executable = false;
  bool shared = false;      // writes reach a file or another process
  std::uint64_t inode = 0;  // 0: anonymous
  std::string name;         // path, [stack], [heap], … or empty

  [[nodiscard]] std::size_t bytes() const { return end - begin; }
};

// One line without its newline, for example "7f00-7f01 r-xp 00002000 fe:00 247134   /usr/bin/cat".
[[nodiscard]] Result<Mapping> parse_mapping(std::string_view line);

// In the order of addresses.
[[nodiscard]] Result<std::vector<Mapping>> read_memory_map();

}  // namespace lxd
