// SPDX-License-Identifier: Apache-2.0
// A smooth curve through or near timed poses.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "tools/simulator/motion/trajectory.hpp"

namespace lxd::sim {

struct PathSample {
  double t_s = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();            // m
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  // either sign
};

struct FitConfig {
  double step_s = 0.05;  // of the knots: half of it is the shortest period that the curve can follow
  // What is slower is followed, what is faster is taken as noise: the response is 1 / (1 + (f / cutoff)^6), as of a
  // smoothing spline with a penalty on the third derivative. Infinite: as close as the knots allow.
  double position_cutoff_hz = std::numeric_limits<double>::infinity();
  double rotation_cutoff_hz = std::numeric_limits<double>::infinity();
};

struct PathFit {
  Trajectory motion;
  // Of the samples from the curve.
  double position_rms_m = 0, position_max_m = 0;
  double angle_rms_rad = 0, angle_max_rad = 0;
};

// From the first to the last sample: at least three, strictly increasing in time.
PathFit fit_path(std::span<const PathSample> samples, const FitConfig& config);

// The curve through samples that are step_s apart, the first at begin_s: samples[i] is met at begin_s + i * step_s, to
// 1e-6 of whatever changes slower than an eighth of the sample rate. The curve reaches from kBefore samples after the
// first to kAfter before the last. Runs of equal samples are at rest exactly, but for six steps at either end.
Trajectory interpolate(double begin_s, double step_s, const std::vector<PathSample>& samples);

}  // namespace lxd::sim
