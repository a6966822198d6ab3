// SPDX-License-Identifier: Apache-2.0
// What lxd-slam tells its caller: scripts and services branch on these three.
#pragma once

namespace lxd::exit_status {

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;    // at run time: a damaged recording, a full disk
inline constexpr int kBadUsage = 2;  // the command line, the rig or the recording as a whole

}  // namespace lxd::exit_status
