// SPDX-License-Identifier: Apache-2.0
// Whether the tests run in an emulator (tools/test --arm sets LXD_EMULATED): page faults there are the emulator's own.
#pragma once

#include <cstdlib>

namespace lxd::test {

inline bool emulated() { return std::getenv("LXD_EMULATED") != nullptr; }

}  // namespace lxd::test
