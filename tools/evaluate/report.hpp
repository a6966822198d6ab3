// SPDX-License-Identifier: Apache-2.0
// Everything `evaluate` finds out, as numbers. Errors in metres and radians; angles are turned to degrees when printed.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/evaluate/statistics.hpp"

namespace lxd {

// Relative error over a way or a time.
struct RelativeError {
  std::string unit;       // "m" of way or "s"
  double delta = 0;       // wanted
  double delta_mean = 0;  // reached: poses are where they are
  Statistics translation_m;
  std::optional<Statistics> rotation_rad;
};

// KITTI odometry's measure over all segments of one length.
struct SegmentError {
  double length_m = 0;
  std::size_t segments = 0;
  double translation_ratio = 0;  // error per metre of way; times 100: per cent
  double rotation_rad_per_m = 0;
};

struct KittiErrors {
  std::vector<SegmentError> lengths;
  double translation_ratio = 0;  // mean over all segments
  double rotation_rad_per_m = 0;
};

// Normalised estimation error squared against the filter's own covariance; its dimension on average when consistent.
struct Consistency {
  std::size_t poses = 0;
  std::size_t skipped = 0;  // no covariance of that stamp, or one that is not positive definite
  double nees_pose = 0, nees_rotation = 0, nees_position = 0;  // averages; dimensions 6, 3, 3
  double lower_95 = 0, upper_95 = 0;                           // of nees_pose's average, were the errors independent
  double share_within_95 = 0;  // poses whose own NEES lies within the two-sided 95 % of chi^2(6)
};

struct ThresholdScore {
  double threshold_m = 0;
  double precision = 0, recall = 0, f_score = 0;
};

struct MeshErrors {
  std::size_t vertices = 0, faces = 0;
  double area_m2 = 0;
  Statistics accuracy_m;      // mesh to world
  Statistics completeness_m;  // world to mesh, of the world that counts
  std::size_t world_samples = 0, world_samples_counted = 0;
  std::vector<ThresholdScore> scores;
};

struct EvaluationReport {
  std::size_t estimate_poses = 0, truth_poses = 0, matched = 0, unmatched = 0;
  double duration_s = 0;  // of the matched part
  double truth_path_m = 0, estimate_path_m = 0;
  double final_drift_m = 0;  // last pose after alignment by the first
  Statistics ate_m;
  std::optional<Statistics> orientation_rad;
  std::vector<RelativeError> relative;
  std::optional<KittiErrors> kitti;
  std::optional<Consistency> consistency;
  std::optional<MeshErrors> mesh;
};

}  // namespace lxd
