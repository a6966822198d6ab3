// SPDX-License-Identifier: Apache-2.0
// Is an error as large as its own standard deviation says?
#pragma once

#include <vector>

#include "tools/evaluate/report.hpp"

namespace lxd {

struct ClaimedError {
  double error_m;
  double sigma_m;  // what it should be
};

// Errors at reach_m or more belong to no surface (the distance was cut off there): they count as outside of every sigma
// and are left out of the squares. A sigma of zero is no claim and is left out altogether. Deciles by sigma: equal
// numbers of samples, the smallest sigmas first.
MeshCalibration calibration(std::vector<ClaimedError> errors, double reach_m);

}  // namespace lxd
