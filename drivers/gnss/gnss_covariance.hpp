// SPDX-License-Identifier: Apache-2.0
// How far a fix can be off: what the receiver says of it (GST), else what its sort of fix and the satellites' geometry
// let expect.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "drivers/gnss/gnss_fix.hpp"

namespace lxd {

struct GnssCovariance {
  Eigen::Matrix3d enu_m2 = Eigen::Matrix3d::Zero();  // east, north, up; positive definite
  bool said = false;                                 // by the receiver; otherwise assumed
};

// None: the fix has no position, or its quality is of a sort that has no known error (manual, simulator).
std::optional<GnssCovariance> covariance_of(const GnssFix& fix);

}  // namespace lxd
