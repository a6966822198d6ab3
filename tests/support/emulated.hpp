// SPDX-License-Identifier: Apache-2.0
// Whether the tests run in qemu's user emulation (the preset arm64 sets LXD_EMULATED): page faults there are the
// emulator's own, and it has neither the kernel's stamps of datagrams and frames nor the settings of a serial line.
// Both have their tests in a guest with a kernel of its own (tests/hil).
#pragma once

#include <cstdlib>

namespace lxd::test {

inline bool emulated() { return std::getenv("LXD_EMULATED") != nullptr; }

inline constexpr const char* kNoKernelStamps = "the emulator has no kernel stamps";
inline constexpr const char* kNoSerialLine = "the emulator cannot set up a serial line";

}  // namespace lxd::test
