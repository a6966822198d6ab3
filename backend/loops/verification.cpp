// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/verification.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr float kUpright = 0.7F;  // |z| of normals of what is no floor and no ceiling

std::vector<Surfel> thinned(std::span<const Surfel> surfels, const VerificationConfig& config) {
  std::vector<Surfel> all = thin_surfels(surfels, config.query_voxel_m);
  const auto max = static_cast<std::size_t>(config.surfels_max);
  if (all.size() <= max) return all;
  std::vector<Surfel> out;
  out.reserve(max);
  for (std::size_t i = 0; i < max; ++i) out.push_back(all[i * all.size() / max]);
  return out;
}

struct Overlap {
  int seen = 0;    // standing surfels of the one place where the other has seen
  int agreed = 0;  // of them, that lie upon a surface of the other
  [[nodiscard]] double share() const { return seen > 0 ? static_cast<double>(agreed) / seen : 0.0; }
};

// `T` takes the surfels to the axes of the grid and of the context.
Overlap count_overlap(std::span<const Surfel> surfels, const Pose& T, const SurfelGrid& grid,
                      const ScanContext& context, const ContextConfig& context_config,
                      const VerificationConfig& config) {
  Overlap out;
  const Eigen::Matrix3f R = T.R.cast<float>();
  const Eigen::Vector3f p = T.p.cast<float>();
  for (const Surfel& s : surfels) {
    if (std::abs(s.normal.z()) > kUpright) continue;
    const Eigen::Vector3f at = R * s.position_m + p;
    if (visibility_at(context, at.cast<double>(), context_config) == Visibility::unknown) continue;
    ++out.seen;
    const Surfel* on = grid.nearest(at, R * s.normal, static_cast<float>(config.registration.fine_reach_m));
    if (on != nullptr && std::abs(on->normal.dot(at - on->position_m)) < static_cast<float>(config.agree_m))
      ++out.agreed;
  }
  return out;
}

Pose start_of(const PlanFit& fit, const Surroundings& query, const Surroundings& candidate) {
  Pose T;
  T.R = Exp(Eigen::Vector3d(0, 0, fit.yaw_rad));
  T.p << fit.p_m, query.height_m - candidate.height_m;
  return T;
}

LoopVerdict judge(const Verification& v, int seen, double moved_m, const VerificationConfig& config) {
  if (seen < config.surfels_min) return LoopVerdict::little_seen;
  if (v.overlap < config.overlap_min) return LoopVerdict::little_overlap;
  if (v.rms_m > config.rms_max_m) return LoopVerdict::poor_fit;
  if (moved_m > config.moved_max_m) return LoopVerdict::moved_away;
  if (v.rival_score > config.rival_max * v.plan_score) return LoopVerdict::ambiguous;
  if (v.open_sigma_m > config.open_sigma_max_m) return LoopVerdict::open;
  return LoopVerdict::accepted;
}

}  // namespace

Surroundings surroundings_of(std::span<const Surfel> submesh, const Eigen::Vector3d& place_m,
                             const ScanContext& context, double radius_m) {
  Surroundings out;
  out.context = context;
  out.height_m = height_above_ground_m(submesh, place_m);
  for (Surfel s : submesh) {
    const Eigen::Vector3d d = s.position_m.cast<double>() - place_m;
    if (d.head<2>().squaredNorm() > radius_m * radius_m) continue;
    s.position_m = d.cast<float>();
    out.surfels.push_back(s);
  }
  return out;
}

Matrix6d honest_covariance(const Registration& registration, const VerificationConfig& config) {
  constexpr double kOpen_rad = 1, kOpen_m = 10, kLeast = 1e-9;
  const Matrix6d noise = registration.noise + kLeast * Matrix6d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> solver(registration.information, noise);
  Matrix6d held = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const double ratio = solver.eigenvalues()[i];
    const Vector6d along = noise * solver.eigenvectors().col(i);
    held += std::max(0.0, ratio - 2) * along * along.transpose();
  }
  held /= config.rows_per_look;
  held.diagonal().head<3>().array() += 1 / (kOpen_rad * kOpen_rad);
  held.diagonal().tail<3>().array() += 1 / (kOpen_m * kOpen_m);
  Matrix6d covariance = held.ldlt().solve(Matrix6d::Identity());
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  covariance.diagonal().head<3>().array() += config.drift_sigma_rad * config.drift_sigma_rad;
  covariance.diagonal().tail<3>().array() += config.drift_sigma_m * config.drift_sigma_m;
  return covariance;
}

Verification verify_loop(const Surroundings& query, const Surroundings& candidate, double yaw_guess_rad,
                         const ContextConfig& context_config, const VerificationConfig& config) {
  const PlanFit fit = search_plan(query.surfels, candidate.surfels, yaw_guess_rad, config.plan);
  const Pose start = start_of(fit, query, candidate);
  const std::vector<Surfel> here = thinned(query.surfels, config), there = thinned(candidate.surfels, config);
  const SurfaceRegistration registration(candidate.surfels, config.registration);
  const Registration found = registration.run(here, start);
  Verification out;
  out.T_candidate_query = found.T_candidate_query;
  out.plan_score = fit.score;
  out.rival_score = fit.rival;
  out.rms_m = found.rms_m;
  // Both ways: what the one place has and the other has not speaks against them, whichever it is.
  const Pose& T = found.T_candidate_query;
  const SurfelGrid grid(query.surfels, config.registration.fine_reach_m);
  const Overlap forth = count_overlap(here, T, registration.fine(), candidate.context, context_config, config);
  const Overlap back = count_overlap(there, T.inverse(), grid, query.context, context_config, config);
  out.overlap = std::min(forth.share(), back.share());
  out.covariance = honest_covariance(found, config);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> position(out.covariance.bottomRightCorner<3, 3>());
  out.open_sigma_m = std::sqrt(position.eigenvalues().maxCoeff());
  out.verdict = judge(out, std::min(forth.seen, back.seen), (found.T_candidate_query.p - start.p).norm(), config);
  return out;
}

}  // namespace lxd
