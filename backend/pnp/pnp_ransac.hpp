// SPDX-License-Identifier: Apache-2.0
// Pose hypotheses for bidirectional PnP: P3P on samples of the forward set, the best by inliers of both sets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "backend/pnp/projection_residual.hpp"

namespace lxd {

struct PnpHypothesis {
  Pose T_CH;
  std::vector<bool> inliers;  // by constraint
  int count = 0;              // of them
};

struct RansacConfig {
  int samples_max = 300;
  double inlier_chi2 = 9.21;
  std::uint32_t seed = 1;
};

// Which constraints agree with a pose.
PnpHypothesis count_inliers(std::span<const ProjectionConstraint> constraints, const Pose& T_CH, double inlier_chi2);

// `forward` is how many of the constraints, which come first, are of the forward set. Without four of them: no inliers.
PnpHypothesis best_hypothesis(std::span<const ProjectionConstraint> constraints, std::size_t forward,
                              const RansacConfig& config);

}  // namespace lxd
