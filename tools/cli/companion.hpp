// SPDX-License-Identifier: Apache-2.0
// Commands that are programs of their own, beside lxd-slam.
#pragma once

namespace lxd {

// Becomes lxd-slam-simulate, with the same arguments. Returns only when there is none: the exit status.
int become_simulator(const char* const* argv);

}  // namespace lxd
