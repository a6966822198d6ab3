// SPDX-License-Identifier: Apache-2.0
// Errors of a path: absolute (after alignment), relative over ways and times, and KITTI's segments.
#pragma once

#include <span>
#include <vector>

#include "tools/evaluate/associate.hpp"
#include "tools/evaluate/report.hpp"

namespace lxd {

// |truth.p - T_truth_map * estimate.p| (Sturm et al., IROS 2012).
Statistics absolute_errors(std::span<const PosePair> pairs, const Pose& T_truth_map);
// Angle of R_truth^T R_truth_map R_estimate.
Statistics orientation_errors(std::span<const PosePair> pairs, const Pose& T_truth_map);

// Angle between two attitudes, 0 .. pi rad.
double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

// Way since the first pair, along the truth; and along the estimate.
std::vector<double> truth_way(std::span<const PosePair> pairs);
std::vector<double> estimate_way(std::span<const PosePair> pairs);

// From every pose to the first that is `delta` further by `progress` (way in m, or seconds; grows with the pairs):
// (Q_i^-1 Q_j)^-1 (P_i^-1 P_j). Independent of alignment.
RelativeError relative_errors(std::span<const PosePair> pairs, std::span<const double> progress, double delta);

// KITTI odometry development kit, `evaluate_odometry.cpp`: segments of 100, 200 ... 800 m, begun at every tenth pose.
// Paths below 200 m (20 m) are measured over tenths (hundredths) of these lengths, begun at every pose.
KittiErrors kitti_errors(std::span<const PosePair> pairs);

}  // namespace lxd
