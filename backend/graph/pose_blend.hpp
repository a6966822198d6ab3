// SPDX-License-Identifier: Apache-2.0
// A pose between two: the rotation goes the short way round, the position straight.
#pragma once

#include "rt/pose.hpp"
#include "rt/so3.hpp"

namespace lxd {

// share 0: a, share 1: b.
inline Pose blend(const Pose& a, const Pose& b, double share) {
  return {a.R * Exp(share * Log(a.R.transpose() * b.R)), a.p + share * (b.p - a.p)};
}

}  // namespace lxd
