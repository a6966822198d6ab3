// SPDX-License-Identifier: Apache-2.0
// What made kernels share: how a call fails.
#pragma once

#include <cerrno>

namespace lxd::test {

inline int failed_call(int cause) {
  errno = cause;
  return -1;
}

}  // namespace lxd::test
