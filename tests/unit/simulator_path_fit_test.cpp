// SPDX-License-Identifier: Apache-2.0
// Curves through and near samples: that they follow what they should, leave out what they should, and stand still.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "rt/so3.hpp"
#include "tools/simulator/motion/path_fit.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim::simulator_path_fit_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Circles with a nod: nothing faster than 0.5 Hz.
PathSample smooth(double t_s) {
  const double phase = std::numbers::pi * t_s;
  return {t_s,
          {3 * std::cos(phase / 2), 2 * std::sin(phase / 2), 0.2 * std::sin(phase)},
          Quaterniond(Exp(Vector3d(0, 0, 2 * t_s))) * Quaterniond(Exp(Vector3d(0.2 * std::sin(phase), 0, 0)))};
}

std::vector<PathSample> sampled(double rate_hz, double duration_s) {
  std::vector<PathSample> samples;
  for (int i = 0; i <= std::lround(rate_hz * duration_s); ++i) {
    samples.push_back(smooth(i / rate_hz));
    if (i % 2 == 1) samples.back().q.coeffs() *= -1;  // the same rotation
  }
  return samples;
}

double angle(const Pose& a, const Quaterniond& b) { return Log(a.R.transpose() * b.toRotationMatrix()).norm(); }

TEST(SimulatorPathFit, FollowsSmoothSamples) {
  const PathFit fit = fit_path(sampled(20, 10), FitConfig{});
  EXPECT_LT(fit.position_max_m, 1e-5);
  EXPECT_LT(fit.angle_max_rad, 1e-4);
  for (double t = 1; t < 9; t += 0.0137) {
    EXPECT_LT((fit.motion.pose(t).p - smooth(t).p).norm(), 1e-5) << t;
    EXPECT_LT(angle(fit.motion.pose(t), smooth(t).q), 1e-4) << t;
  }
}

TEST(SimulatorPathFit, NoiseAboveTheCutoffGoesAndMotionBelowStays) {
  std::vector<PathSample> samples = sampled(100, 10);
  Random random(1, "noise");
  const auto noise = [&](double sigma) {
    return Vector3d(random.normal(sigma), random.normal(sigma), random.normal(sigma));
  };
  for (PathSample& sample : samples) {
    sample.p += noise(0.01);
    sample.q = sample.q * Quaterniond(Exp(noise(0.01)));
  }
  const PathFit fit = fit_path(samples, {.step_s = 0.05, .position_cutoff_hz = 2, .rotation_cutoff_hz = 2});
  EXPECT_NEAR(fit.position_rms_m, 0.01 * std::sqrt(3.0), 0.001);
  EXPECT_NEAR(fit.angle_rms_rad, 0.01 * std::sqrt(3.0), 0.001);
  double sum = 0;
  for (double t = 1; t < 9; t += 0.01) sum += (fit.motion.pose(t).p - smooth(t).p).squaredNorm();
  EXPECT_LT(std::sqrt(sum / 800), 0.005);  // a fifth of the noise's band is left
}

TEST(SimulatorPathFit, ResponseIsAHalfAtTheCutoff) {
  std::vector<PathSample> samples;
  for (int i = 0; i <= 2000; ++i) {
    const double t = 0.01 * i;
    samples.push_back({t, {std::sin(2 * std::numbers::pi * t), 0, 0}, Quaterniond::Identity()});
  }
  const PathFit fit = fit_path(samples, {.step_s = 0.05, .position_cutoff_hz = 1});
  EXPECT_NEAR(fit.motion.pose(10.25).p.x(), 0.5, 0.01);
}

TEST(SimulatorPathFit, GapsAreBridged) {
  std::vector<PathSample> samples = sampled(20, 10);
  samples.erase(samples.begin() + 100, samples.begin() + 108);  // 0.4 s
  const PathFit fit = fit_path(samples, FitConfig{});
  for (double t = 4.9; t < 5.6; t += 0.01) EXPECT_LT((fit.motion.pose(t).p - smooth(t).p).norm(), 0.01) << t;
}

TEST(SimulatorPathFit, ThreeSamplesAreAStraightWay) {
  const std::vector<PathSample> samples{{0, Vector3d::Zero(), Quaterniond::Identity()},
                                        {0.5, Vector3d(0.5, 0, 0), Quaterniond::Identity()},
                                        {1, Vector3d(1, 0, 0), Quaterniond::Identity()}};
  const PathFit fit = fit_path(samples, FitConfig{});
  EXPECT_LT((fit.motion.pose(0.0).p).norm(), 1e-3);
  EXPECT_LT((fit.motion.pose(1.0).p - Vector3d(1, 0, 0)).norm(), 1e-3);
}

TEST(SimulatorPathFit, InterpolationMeetsItsSamples) {
  const std::vector<PathSample> samples = sampled(50, 5);
  const Trajectory motion = interpolate(0, 0.02, samples);
  for (std::size_t i = 20; i + 20 < samples.size(); ++i) {
    EXPECT_LT((motion.pose(samples[i].t_s).p - samples[i].p).norm(), 1e-9);
    EXPECT_LT(angle(motion.pose(samples[i].t_s), samples[i].q), 1e-9);
  }
}

TEST(SimulatorPathFit, EqualSamplesAreAtRestExactly) {
  std::vector<PathSample> samples = sampled(100, 3);
  for (int i = 0; i < 100; ++i) samples.insert(samples.begin(), samples.front());
  const Trajectory motion = interpolate(-1, 0.01, samples);
  for (double t = motion.begin_s(); t < -0.06; t += 0.007) {
    const MotionState state = motion.at(t);
    EXPECT_EQ(state.v_world_mps, Vector3d::Zero()) << t;
    EXPECT_EQ(state.a_world_mps2, Vector3d::Zero()) << t;
    EXPECT_EQ(state.omega_body_radps, Vector3d::Zero()) << t;
  }
  EXPECT_GT(motion.at(0.5).v_world_mps.norm(), 0.1);
}

}  // namespace
}  // namespace lxd::sim::simulator_path_fit_test
