// SPDX-License-Identifier: Apache-2.0
// The devices of a live rig that are neither network nor line: its camera, its pulse and its triggers.
#pragma once

#include "board/live_rig.hpp"

namespace lxd {

// Those that have a wire, to the others. None needs to be there yet. `clock` and the kernel's calls outlive them.
void open_signals(const LiveRig& live, const HostClock& clock, const LiveKernel& kernel, LiveDevices& opened);

}  // namespace lxd
