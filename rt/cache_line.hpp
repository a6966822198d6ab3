// SPDX-License-Identifier: Apache-2.0
// Distance that keeps what two threads write apart.
#pragma once

#include <cstddef>

namespace lxd {

// 64 bytes on x86-64 and on the ARM cores we build for. Not std::hardware_destructive_interference_size: gcc lets that
// one change with -mtune, which would change the layout of classes between translation units.
inline constexpr std::size_t kCacheLine_bytes = 64;

}  // namespace lxd
