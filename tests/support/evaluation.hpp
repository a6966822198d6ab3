// SPDX-License-Identifier: Apache-2.0
// Paths whose errors are known, and their evaluation through files, as the command line does it.
#pragma once

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "backend/trajectory_writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/evaluate.hpp"

namespace lxd::test {

inline Pose rigid(double angle_rad, const Eigen::Vector3d& axis, const Eigen::Vector3d& p) {
  return {Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix(), p};
}

// A climbing helix at 10 Hz: every direction of position and attitude is excited.
inline std::vector<StampedPose> helix(int count) {
  std::vector<StampedPose> path;
  for (int i = 0; i < count; ++i) {
    const double a = 0.02 * i;
    path.push_back({RigTime::from_ns(1'700'000'000'000'000'000 + i * 100'000'000LL),
                    rigid(a, {0.1, 0.2, 1}, {10 * std::cos(a), 10 * std::sin(a), 0.5 * std::sin(3 * a)})});
  }
  return path;
}

inline std::vector<StampedPose> straight(int count, double step_m) {
  std::vector<StampedPose> path;
  for (int i = 0; i < count; ++i)
    path.push_back({RigTime::from_ns(i * 100'000'000LL), {Eigen::Matrix3d::Identity(), {i * step_m, 0, 0}}});
  return path;
}

template <typename Change>
std::vector<StampedPose> changed(std::vector<StampedPose> path, Change change) {
  for (std::size_t i = 0; i < path.size(); ++i) change(path[i], i);
  return path;
}

class Evaluation : public ::testing::Test {
 protected:
  EvaluationReport run(const std::vector<StampedPose>& estimate, const std::vector<StampedPose>& truth) {
    EXPECT_TRUE(write_trajectory(folder_ / "estimate.tum", estimate).ok());
    EXPECT_TRUE(write_trajectory(folder_ / "truth.tum", truth).ok());
    const auto report = evaluate(options());
    EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.error().message);
    return report.ok() ? *report : EvaluationReport{};
  }
  EvaluateOptions options() {
    EvaluateOptions options;
    options.estimate = folder_ / "estimate.tum";
    options.truth = folder_ / "truth.tum";
    return options;
  }
  TemporaryFolder folder_;
};

}  // namespace lxd::test
