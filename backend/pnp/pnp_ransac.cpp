// SPDX-License-Identifier: Apache-2.0
#include "backend/pnp/pnp_ransac.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr std::size_t kSample = 3;
constexpr double kConfidence = 0.999;  // that one sample without outliers was drawn

using Sample = std::array<std::size_t, kSample>;

// Three different ones. The draw is spelled out: the library's distributions differ between implementations.
Sample draw(std::mt19937& engine, std::size_t count) {
  Sample out{};
  for (std::size_t i = 0; i < kSample; ++i) {
    do {
      out[i] = engine() % count;
    } while (std::find(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(i), out[i]) !=
             out.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return out;
}

// Up to four poses that put three points onto their pixels.
std::vector<Pose> solve_p3p(std::span<const ProjectionConstraint> constraints, const Sample& sample) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const std::size_t i : sample) {
    const ProjectionConstraint& c = constraints[i];
    points.emplace_back(c.point_m.x(), c.point_m.y(), c.point_m.z());
    pixels.emplace_back(c.seen.x(), c.seen.y());
  }
  std::vector<cv::Mat> rotations, translations;
  cv::solveP3P(points, pixels, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations, translations, cv::SOLVEPNP_P3P);
  std::vector<Pose> out;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const auto vector = [](const cv::Mat& m) {
      return Eigen::Vector3d(m.at<double>(0), m.at<double>(1), m.at<double>(2));
    };
    const Pose pose{Exp(vector(rotations[i])), vector(translations[i])};
    if (pose.R.allFinite() && pose.p.allFinite()) out.push_back(pose);
  }
  return out;
}

// How many samples are enough when this share of them is sound.
double samples_wanted(double inlier_share) {
  const double all_sound = std::pow(inlier_share, static_cast<double>(kSample));
  if (all_sound >= 1) return 1;
  return std::log(1 - kConfidence) / std::log1p(-all_sound);
}

}  // namespace

PnpHypothesis count_inliers(std::span<const ProjectionConstraint> constraints, const Pose& T_CH, double inlier_chi2) {
  PnpHypothesis out;
  out.T_CH = T_CH;
  out.inliers.resize(constraints.size());
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    ProjectionResidual residual;
    const bool fits = project_constraint(constraints[i], T_CH, residual) && residual.r.squaredNorm() < inlier_chi2;
    out.inliers[i] = fits;
    out.count += fits ? 1 : 0;
  }
  return out;
}

PnpHypothesis best_hypothesis(std::span<const ProjectionConstraint> constraints, std::size_t forward,
                              const RansacConfig& config) {
  PnpHypothesis best;
  best.inliers.resize(constraints.size());
  if (forward <= kSample) return best;
  std::mt19937 engine(config.seed);
  double wanted = config.samples_max;
  for (int i = 0; i < config.samples_max && i < wanted; ++i) {
    for (const Pose& pose : solve_p3p(constraints, draw(engine, forward))) {
      PnpHypothesis hypothesis = count_inliers(constraints, pose, config.inlier_chi2);
      if (hypothesis.count <= best.count) continue;
      best = std::move(hypothesis);
      const auto sound =
          std::count(best.inliers.begin(), best.inliers.begin() + static_cast<std::ptrdiff_t>(forward), true);
      wanted = sound > 0 ? samples_wanted(static_cast<double>(sound) / static_cast<double>(forward)) : wanted;
    }
  }
  return best;
}

}  // namespace lxd
