// SPDX-License-Identifier: Apache-2.0
// Bidirectional PnP (paper, "Visual Loop Closure via Bidirectional PnP Realignment"): the relative pose of two cameras
// from landmarks of either that the other sees.
#pragma once

#include <cstdint>
#include <optional>

#include "backend/loop_measurement.hpp"
#include "backend/pnp/feature_match.hpp"
#include "backend/pnp/projection_residual.hpp"
#include "backend/pnp/visual_key_frame.hpp"

namespace lxd {

struct PnpConfig {
  FeatureMatchConfig match;
  bool backward = true;       // set B takes part; without it this is the usual PnP, for comparison
  int samples_max = 300;      // of the forward set
  double inlier_chi2 = 9.21;  // 2 degrees of freedom, 99 %
  int inliers_min = 20;       // of both sets; half of it of the forward set alone
  double inlier_share_min = 0.3;
  double sigma_max_m = 0.5;        // along the worst direction
  double match_sigma_rad = 0.002;  // of what a descriptor takes for one point, besides the features' own
  std::uint32_t seed = 1;
};

enum class PnpVerdict : std::uint8_t { accepted, few_matches, few_inliers, uncertain };

struct PnpResult {
  PnpVerdict verdict = PnpVerdict::few_matches;
  Pose T_CH;                                   // historical camera -> current camera
  Matrix6d covariance = Matrix6d::Identity();  // [rotation (right), position]
  int forward = 0, backward = 0;               // inliers
  int constraints = 0;
};

PnpResult solve_pnp(const VisualKeyFrame& historical, const VisualKeyFrame& current,
                    std::span<const FeatureMatch> matches, const PnpConfig& config);

// Match, solve, and the relative pose of the two bodies. None: not accepted.
std::optional<LoopMeasurement> visual_loop(const VisualKeyFrame& historical, const VisualKeyFrame& current,
                                           const PnpConfig& config);

// Between the bodies, from the historical to the current one, from that between the cameras.
LoopMeasurement loop_of_cameras(const VisualKeyFrame& historical, const VisualKeyFrame& current,
                                const PnpResult& found);

}  // namespace lxd
