// SPDX-License-Identifier: Apache-2.0
#include "backend/pnp/bidirectional_pnp.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "backend/pnp/pnp_ransac.hpp"
#include "backend/pnp/pnp_refinement.hpp"
#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr int kRefinements = 3;  // inliers are counted anew after each

std::vector<ProjectionConstraint> agreeing(std::span<const ProjectionConstraint> all,
                                           const std::vector<bool>& inliers) {
  std::vector<ProjectionConstraint> out;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (inliers[i]) out.push_back(all[i]);
  return out;
}

std::vector<ProjectionConstraint> wanted_constraints(const VisualKeyFrame& historical, const VisualKeyFrame& current,
                                                     std::span<const FeatureMatch> matches, const PnpConfig& config) {
  std::vector<ProjectionConstraint> out = constraints_of(historical, current, matches);
  if (!config.backward)
    std::erase_if(out, [](const ProjectionConstraint& c) { return c.direction == Direction::backward; });
  for (ProjectionConstraint& c : out) c.seen_sigma = Eigen::Vector2d(c.seen_sigma, config.match_sigma_rad).norm();
  return out;
}

void count_directions(std::span<const ProjectionConstraint> constraints, const std::vector<bool>& inliers,
                      PnpResult& out) {
  out.forward = out.backward = 0;
  for (std::size_t i = 0; i < constraints.size(); ++i)
    (constraints[i].direction == Direction::forward ? out.forward : out.backward) += inliers[i] ? 1 : 0;
}

bool has_enough(const PnpResult& result, const PnpConfig& config) {
  const int inliers = result.forward + result.backward;
  return inliers >= config.inliers_min && result.forward >= config.inliers_min / 2 &&
         inliers >= config.inlier_share_min * result.constraints;
}

double worst_sigma_m(const Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.bottomRightCorner<3, 3>());
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

// A match of two points is a constraint each way, from one pair of sightings: together they are worth no more than the
// share of them that are different matches.
double independent_share(std::size_t matches, int constraints) {
  return std::min(1.0, static_cast<double>(matches) / std::max(1, constraints));
}

}  // namespace

PnpResult solve_pnp(const VisualKeyFrame& historical, const VisualKeyFrame& current,
                    std::span<const FeatureMatch> matches, const PnpConfig& config) {
  PnpResult out;
  const auto constraints = wanted_constraints(historical, current, matches, config);
  const auto forward =
      static_cast<std::size_t>(std::count_if(constraints.begin(), constraints.end(), [](const ProjectionConstraint& c) {
        return c.direction == Direction::forward;
      }));
  out.constraints = static_cast<int>(constraints.size());
  if (out.constraints < config.inliers_min) return out;
  PnpHypothesis best = best_hypothesis(constraints, forward, {config.samples_max, config.inlier_chi2, config.seed});
  out.verdict = PnpVerdict::few_inliers;
  for (int i = 0; i < kRefinements; ++i) {
    count_directions(constraints, best.inliers, out);
    if (!has_enough(out, config)) return out;
    const auto information = refine_pose(agreeing(constraints, best.inliers), best.T_CH);
    if (!information) return out;
    const double share = independent_share(matches.size(), out.constraints);
    out.covariance = (share * *information).ldlt().solve(Matrix6d::Identity());
    out.T_CH = best.T_CH;
    best = count_inliers(constraints, best.T_CH, config.inlier_chi2);
  }
  const double sigma_m = worst_sigma_m(out.covariance);
  out.verdict = sigma_m < config.sigma_max_m ? PnpVerdict::accepted : PnpVerdict::uncertain;
  return out;
}

// A step [d, e] of T_CH is one of [-R_CH d, t_HC^ d - R_HC e] of its inverse; a frame put behind it, T_HC M, turns the
// rotation by R_M^T and adds -R_HC t_M^ d to the position; one put before it turns the position.
LoopMeasurement loop_of_cameras(const VisualKeyFrame& historical, const VisualKeyFrame& current,
                                const PnpResult& found) {
  const Pose T_HC = found.T_CH.inverse(), T_CB = current.T_body_camera.inverse();
  Matrix6d inverse = Matrix6d::Zero();
  inverse.topLeftCorner<3, 3>() = -found.T_CH.R;
  inverse.bottomLeftCorner<3, 3>() = hat(T_HC.p);
  inverse.bottomRightCorner<3, 3>() = -T_HC.R;
  Matrix6d bodies = Matrix6d::Zero();
  bodies.topLeftCorner<3, 3>() = T_CB.R.transpose();
  bodies.bottomLeftCorner<3, 3>() = -historical.T_body_camera.R * T_HC.R * hat(T_CB.p);
  bodies.bottomRightCorner<3, 3>() = historical.T_body_camera.R;
  const Matrix6d J = bodies * inverse;
  LoopMeasurement out;
  out.from = historical.id;
  out.to = current.id;
  out.T_from_to = historical.T_body_camera * T_HC * T_CB;
  out.covariance = J * found.covariance * J.transpose();
  out.by = LoopSense::sight;
  return out;
}

std::optional<LoopMeasurement> visual_loop(const VisualKeyFrame& historical, const VisualKeyFrame& current,
                                           const PnpConfig& config) {
  const auto matches = match_features(historical.features, current.features, config.match);
  const PnpResult found = solve_pnp(historical, current, matches, config);
  if (found.verdict != PnpVerdict::accepted) return std::nullopt;
  return loop_of_cameras(historical, current, found);
}

}  // namespace lxd
