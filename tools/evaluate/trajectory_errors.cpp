// SPDX-License-Identifier: Apache-2.0
// Errors of a path.
#include "tools/evaluate/trajectory_errors.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

// Well-behaved for tiny angles, where acos of the trace is not.
double angle_rad(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

Pose relative_error(const PosePair& from, const PosePair& to) {
  return (from.truth.inverse() * to.truth).inverse() * (from.estimate.inverse() * to.estimate);
}

std::vector<double> way(std::span<const PosePair> pairs, Pose PosePair::*which) {
  std::vector<double> way(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i)
    way[i] = way[i - 1] + ((pairs[i].*which).p - (pairs[i - 1].*which).p).norm();
  return way;
}

// First index whose progress is at least `delta` beyond that of `from`; size() when there is none.
std::size_t index_after(std::span<const double> progress, std::size_t from, double delta) {
  constexpr double kRounding = 1e-9;  // sums of tenths still reach their whole
  return std::ranges::lower_bound(progress, progress[from] + delta - kRounding) - progress.begin();
}

struct SegmentSums {
  double translation = 0, rotation = 0;
  std::size_t segments = 0;
};

SegmentSums segment_sums(std::span<const PosePair> pairs, std::span<const double> way, double length_m,
                         std::size_t stride) {
  SegmentSums sums;
  for (std::size_t first = 0; first < pairs.size(); first += stride) {
    const std::size_t last = index_after(way, first, length_m);
    if (last >= pairs.size()) break;
    const Pose error = relative_error(pairs[first], pairs[last]);
    sums.translation += error.p.norm() / length_m;
    sums.rotation += angle_rad(error.R) / length_m;
    ++sums.segments;
  }
  return sums;
}

SegmentError mean_of(const SegmentSums& sums, double length_m) {
  const auto count = static_cast<double>(std::max<std::size_t>(sums.segments, 1));
  return {length_m, sums.segments, sums.translation / count, sums.rotation / count};
}

}  // namespace

Statistics absolute_errors(std::span<const PosePair> pairs, const Pose& T_truth_map) {
  std::vector<double> errors_m;
  for (const PosePair& pair : pairs) errors_m.push_back((pair.truth.p - T_truth_map * pair.estimate.p).norm());
  return summarise(std::move(errors_m));
}

Statistics orientation_errors(std::span<const PosePair> pairs, const Pose& T_truth_map) {
  std::vector<double> errors_rad;
  for (const PosePair& pair : pairs) errors_rad.push_back(angle_between(pair.truth.R, T_truth_map.R * pair.estimate.R));
  return summarise(std::move(errors_rad));
}

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) { return angle_rad(a.transpose() * b); }

std::vector<double> truth_way(std::span<const PosePair> pairs) { return way(pairs, &PosePair::truth); }
std::vector<double> estimate_way(std::span<const PosePair> pairs) { return way(pairs, &PosePair::estimate); }

RelativeError relative_errors(std::span<const PosePair> pairs, std::span<const double> progress, double delta) {
  std::vector<double> translations_m;
  std::vector<double> rotations_rad;
  double reached = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::size_t j = index_after(progress, i, delta);
    if (j >= pairs.size()) break;
    const Pose error = relative_error(pairs[i], pairs[j]);
    translations_m.push_back(error.p.norm());
    rotations_rad.push_back(angle_rad(error.R));
    reached += progress[j] - progress[i];
  }
  RelativeError result;
  result.delta = delta;
  result.delta_mean = reached / static_cast<double>(std::max<std::size_t>(translations_m.size(), 1));
  result.translation_m = summarise(std::move(translations_m));
  result.rotation_rad = summarise(std::move(rotations_rad));
  return result;
}

KittiErrors kitti_errors(std::span<const PosePair> pairs) {
  constexpr int kLengths = 8;
  constexpr double kLongest_m = 100;  // unit of length of a path that has room for two such segments
  constexpr std::size_t kKittiStride = 10;
  const std::vector<double> way = truth_way(pairs);
  double unit_m = kLongest_m;
  while (unit_m > 1 && (way.empty() || way.back() < 2 * unit_m)) unit_m /= 10;
  KittiErrors errors;
  SegmentSums all;
  for (int i = 1; i <= kLengths; ++i) {
    const SegmentSums sums = segment_sums(pairs, way, i * unit_m, unit_m < kLongest_m ? 1 : kKittiStride);
    if (sums.segments == 0) break;
    errors.lengths.push_back(mean_of(sums, i * unit_m));
    all = {all.translation + sums.translation, all.rotation + sums.rotation, all.segments + sums.segments};
  }
  const SegmentError mean = mean_of(all, 0);
  errors.translation_ratio = mean.translation_ratio;
  errors.rotation_rad_per_m = mean.rotation_rad_per_m;
  return errors;
}

}  // namespace lxd
