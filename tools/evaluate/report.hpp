// SPDX-License-Identifier: Apache-2.0
// Everything `evaluate` finds out, as numbers. Errors in metres and radians; angles are turned to degrees when printed.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

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

// Normalised innovation squared of the filter's updates, over the dimensions of each; 1 when consistent.
struct InnovationConsistency {
  std::size_t updates = 0;
  double nis_per_dimension = 0;
  double dimensions_mean = 0;         // of an update
  double lower_95 = 0, upper_95 = 0;  // of it, were the updates independent
  double share_within_95 = 0;         // updates whose own NIS lies within the two-sided 95 % of its chi^2
};

// Samples whose claimed standard deviations are alike.
struct CalibrationBin {
  std::size_t samples = 0;
  double claimed_rms_m = 0, actual_rms_m = 0;
};

// Errors over their own claimed standard deviation.
inline constexpr std::array<double, 3> kGaussianWithin{0.682689, 0.954500, 0.997300};  // one, two, three sigma
inline constexpr double kMedianOfChiSquared1 = 0.454936;
struct MeshCalibration {
  std::size_t samples = 0, beyond_reach = 0;  // the latter belong to no surface
  double mean_square = 0;                     // of error / sigma; 1 when calibrated
  double median_square = 0;                   // kMedianOfChiSquared1 when calibrated and Gaussian
  double error_ratio = 0;                     // how many times as large as claimed the errors are, by the median
  std::array<double, 3> share_within{};       // one, two, three sigma
  std::vector<CalibrationBin> deciles;        // by claimed sigma
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
  std::optional<MeshCalibration> calibration;  // where the mesh knows its variance
  std::vector<double> distances_m;             // of each sample of the mesh, for the plots
};

// A matched pose, for the plots. What is not known is NaN.
struct PoseErrors {
  using Vector = Eigen::Matrix<double, 6, 1>;
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double t_s = 0, way_m = 0;                        // since the first pair
  double position_m = 0, turn_rad = kUnknown;       // after alignment of the whole path
  Vector since_start = Vector::Constant(kUnknown);  // [rotation rad, position m], aligned by the first pair
  Vector sigma = Vector::Constant(kUnknown);        // the filter's own, of the same
  double nees = kUnknown;                           // of the pose; dimension 6
};

// One update of the filter, for the plots.
struct InnovationAt {
  double t_s = 0;  // since the first pair
  double nis = 0;
  int dimensions = 0;
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
  std::optional<InnovationConsistency> innovation;
  std::optional<MeshErrors> mesh;
  std::vector<PoseErrors> poses;
  std::vector<InnovationAt> innovations;
};

}  // namespace lxd
