// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/path_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rt/so3.hpp"
#include "tools/simulator/motion/banded_system.hpp"
#include "tools/simulator/motion/spline_basis.hpp"

namespace lxd::sim {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kSweeps = 8;                            // each leaves 0.15 of the error, or less where changes are slow
constexpr std::array<double, 4> kJump{-1, 3, -3, 1};  // third difference
constexpr double kLeastPenalty = 1e-9;                // of one sample's weight: what no sample says is smooth

// Segments and the control points that they need.
struct Knots {
  double begin_s, step_s;
  std::size_t segments;

  [[nodiscard]] std::size_t controls() const { return segments + kSplineOrder - 1; }
  [[nodiscard]] double first_knot_s() const { return begin_s - Trajectory::kBefore * step_s; }
};

Knots knots_over(std::span<const PathSample> samples, double step_s) {
  const double span_s = samples.back().t_s - samples.front().t_s;
  return {samples.front().t_s, step_s, static_cast<std::size_t>(std::max(1.0, std::ceil(span_s / step_s)))};
}

// Per second, samples weigh n |e|^2 and the penalty p |step^3 f'''|^2 / step; the response to f falls to a half where
// both are as large.
double penalty(double cutoff_hz, double samples_per_s, double step_s) {
  if (std::isinf(cutoff_hz)) return kLeastPenalty;
  return std::max(kLeastPenalty, samples_per_s / (std::pow(step_s, 5) * std::pow(2 * std::numbers::pi * cutoff_hz, 6)));
}

template <typename ValueOf>
BandedSystem::Values fitted(std::span<const PathSample> samples, const Knots& knots, double cutoff_hz,
                            const ValueOf& value_of) {
  BandedSystem system(knots.controls(), value_of(0).size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double since = (samples[i].t_s - knots.begin_s) / knots.step_s;
    const double segment = std::clamp(std::floor(since), 0.0, static_cast<double>(knots.segments - 1));
    system.add(static_cast<std::size_t>(segment), spline_weights(since - segment), value_of(i), 1);
  }
  const double rate = static_cast<double>(samples.size()) / (samples.back().t_s - samples.front().t_s);
  for (std::size_t i = 0; i + kJump.size() <= knots.controls(); ++i)
    system.add(i, kJump, penalty(cutoff_hz, rate, knots.step_s));
  return system.solve();
}

std::vector<Vector3d> fitted_positions(std::span<const PathSample> samples, const Knots& knots, double cutoff_hz) {
  const auto solved = fitted(samples, knots, cutoff_hz, [&](std::size_t i) { return VectorXd(samples[i].p); });
  std::vector<Vector3d> positions;
  for (std::ptrdiff_t i = 0; i < solved.rows(); ++i) positions.emplace_back(solved.row(i));
  return positions;
}

// The same rotations, each on the side of the one before it.
std::vector<VectorXd> unwrapped(std::span<const PathSample> samples) {
  std::vector<VectorXd> values;
  for (const PathSample& sample : samples) {
    const VectorXd q = sample.q.normalized().coeffs();
    values.push_back(values.empty() || values.back().dot(q) >= 0 ? q : VectorXd(-q));
  }
  return values;
}

// Moves control points until the curve meets the target of each inner one at its knot.
void refine_rotations(const Knots& knots, const std::vector<Quaterniond>& targets,
                      std::vector<Quaterniond>& rotations) {
  const std::vector<Vector3d> nowhere(rotations.size(), Vector3d::Zero());
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const Trajectory curve(knots.first_knot_s(), knots.step_s, nowhere, rotations);
    for (std::size_t i = Trajectory::kBefore; i + Trajectory::kAfter < rotations.size(); ++i) {
      const double t_s = knots.first_knot_s() + static_cast<double>(i) * knots.step_s;
      const Vector3d error = Log(curve.pose(t_s).R.transpose() * targets[i].toRotationMatrix());
      rotations[i] = (rotations[i] * Quaterniond(Exp(error))).normalized();
    }
  }
}

// Smoothed as unit quaternions are: by component, then normalised. The spline on SO(3) is made to meet that.
std::vector<Quaterniond> fitted_rotations(std::span<const PathSample> samples, const Knots& knots, double cutoff_hz) {
  const std::vector<VectorXd> values = unwrapped(samples);
  const auto solved = fitted(samples, knots, cutoff_hz, [&](std::size_t i) { return values[i]; });
  const SplineWeights at_knot = spline_weights(0);
  std::vector<Quaterniond> rotations;
  for (std::ptrdiff_t i = 0; i < solved.rows(); ++i)
    rotations.push_back(Quaterniond(Eigen::Vector4d(solved.row(i))).normalized());
  std::vector<Quaterniond> targets = rotations;
  for (std::size_t i = Trajectory::kBefore; i + Trajectory::kAfter < rotations.size(); ++i) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::size_t j = 0; j < kSplineOrder; ++j)
      sum += at_knot[j] * Eigen::Vector4d(solved.row(i - Trajectory::kBefore + j));
    targets[i] = Quaterniond(sum).normalized();
  }
  refine_rotations(knots, targets, rotations);
  return rotations;
}

void measure(std::span<const PathSample> samples, PathFit& fit) {
  double positions = 0, angles = 0;
  for (const PathSample& sample : samples) {
    const Pose pose = fit.motion.pose(sample.t_s);
    const double off_m = (pose.p - sample.p).norm();
    const double off_rad = Log(pose.R.transpose() * sample.q.normalized().toRotationMatrix()).norm();
    positions += off_m * off_m;
    angles += off_rad * off_rad;
    fit.position_max_m = std::max(fit.position_max_m, off_m);
    fit.angle_max_rad = std::max(fit.angle_max_rad, off_rad);
  }
  const auto count = static_cast<double>(samples.size());
  fit.position_rms_m = std::sqrt(positions / count);
  fit.angle_rms_rad = std::sqrt(angles / count);
}

void refine_positions(const std::vector<PathSample>& samples, std::vector<Vector3d>& positions) {
  const SplineWeights w = spline_weights(0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const std::vector<Vector3d> before = positions;
    for (std::size_t i = Trajectory::kBefore; i + Trajectory::kAfter < positions.size(); ++i) {
      for (std::size_t j = 0; j < kSplineOrder; ++j)
        positions[i] += w[j] * (samples[i].p - before[i - Trajectory::kBefore + j]);
    }
  }
}

// Whether a sample and all whose control points act with its own are the same.
bool at_rest(const std::vector<PathSample>& samples, std::size_t i) {
  const std::size_t first = i - std::min<std::size_t>(i, Trajectory::kAfter);
  const std::size_t last = std::min(i + Trajectory::kAfter, samples.size() - 1);
  for (std::size_t k = first; k <= last; ++k)
    if (samples[k].p != samples[i].p || samples[k].q.coeffs() != samples[i].q.coeffs()) return false;
  return true;
}

}  // namespace

PathFit fit_path(std::span<const PathSample> samples, const FitConfig& config) {
  const Knots knots = knots_over(samples, config.step_s);
  PathFit fit{{knots.first_knot_s(), knots.step_s, fitted_positions(samples, knots, config.position_cutoff_hz),
               fitted_rotations(samples, knots, config.rotation_cutoff_hz)}};
  measure(samples, fit);
  return fit;
}

Trajectory interpolate(double begin_s, double step_s, const std::vector<PathSample>& samples) {
  std::vector<Vector3d> positions;
  std::vector<Quaterniond> rotations;
  for (const PathSample& sample : samples) {
    positions.push_back(sample.p);
    rotations.push_back(sample.q.normalized());
  }
  const std::vector<Quaterniond> targets = rotations;
  refine_positions(samples, positions);
  refine_rotations({begin_s + Trajectory::kBefore * step_s, step_s, 0}, targets, rotations);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!at_rest(samples, i)) continue;
    positions[i] = samples[i].p;
    rotations[i] = targets[i];
  }
  return {begin_s, step_s, positions, rotations};
}

}  // namespace lxd::sim
