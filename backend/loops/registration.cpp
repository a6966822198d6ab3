// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/registration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr double kConverged = 1e-4;  // rad and m

struct Row {
  double r_m;
  double variance_m2;
  Vector6d h;
  Eigen::Matrix<double, 3, 6> displacement;  // of the point by the pose
};

// r = n^T (R s + p - q); R <- R Exp(dtheta), p <- p + dp.
Row make_row(const Surfel& from, const Surfel& on, const Pose& T, const RegistrationConfig& config) {
  const Eigen::Vector3d s = from.position_m.cast<double>(), n = on.normal.cast<double>();
  const Eigen::Vector3d apart = T * s - on.position_m.cast<double>();
  Row row;
  row.r_m = n.dot(apart);
  row.displacement << -T.R * hat(s), Eigen::Matrix3d::Identity();
  row.h = row.displacement.transpose() * n;
  const double beside2 = std::max(0.0, apart.squaredNorm() - row.r_m * row.r_m);
  row.variance_m2 = static_cast<double>(from.variance_m2 + on.variance_m2) +
                    config.floor_sigma_m * config.floor_sigma_m +
                    config.normal_sigma_rad * config.normal_sigma_rad * beside2;
  return row;
}

}  // namespace

struct SurfaceRegistration::Sums {
  Matrix6d A = Matrix6d::Zero(), plain = Matrix6d::Zero(), noise = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double weight = 0, square = 0;
  int pairs = 0;
};

SurfaceRegistration::SurfaceRegistration(std::span<const Surfel> candidate, const RegistrationConfig& config)
    : config_(config),
      coarse_(thin_surfels(candidate, config.coarse_voxel_m), config.coarse_reach_m),
      fine_(candidate, config.fine_reach_m) {}

SurfaceRegistration::Sums SurfaceRegistration::accumulate(std::span<const Surfel> query, const Pose& T,
                                                          const Level& level) const {
  Sums sums;
  const Eigen::Matrix3f R = T.R.cast<float>();
  const Eigen::Vector3f p = T.p.cast<float>();
  const double k2 = level.reach_m * level.reach_m / 4;  // a residual of half the reach has a quarter of its weight
  for (const Surfel& s : query) {
    const Surfel* on = level.grid->nearest(R * s.position_m + p, R * s.normal, static_cast<float>(level.reach_m));
    if (on == nullptr) continue;
    const Row row = make_row(s, *on, T, config_);
    const double robust = k2 / (k2 + row.r_m * row.r_m), share = robust * robust;
    const double w = share / row.variance_m2;
    sums.A += w * row.h * row.h.transpose();
    sums.b += w * row.r_m * row.h;
    sums.plain += w * row.h * row.h.transpose();
    sums.noise += w * row.displacement.transpose() * row.displacement;
    sums.weight += share;
    sums.square += share * row.r_m * row.r_m;
    ++sums.pairs;
  }
  sums.noise *= config_.normal_sigma_rad * config_.normal_sigma_rad;
  return sums;
}

void SurfaceRegistration::iterate(std::span<const Surfel> query, const Level& level, Registration& out) const {
  Pose& T = out.T_candidate_query;
  for (int i = 0; i < config_.iterations_max; ++i) {
    Sums sums = accumulate(query, T, level);
    out.pairs = sums.pairs;
    if (sums.pairs == 0) return;
    out.information = sums.plain;
    out.noise = sums.noise;
    out.rms_m = std::sqrt(sums.square / sums.weight);
    // The tilt stays about what gravity says; what nothing holds stays where it is.
    const Eigen::Vector3d up = T.R.transpose() * Eigen::Vector3d::UnitZ();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - up * up.transpose();
    const double tilt_weight = 1 / (config_.tilt_sigma_rad * config_.tilt_sigma_rad);
    sums.A.topLeftCorner<3, 3>() += tilt_weight * across;
    sums.b.head<3>() += tilt_weight * up.cross(Eigen::Vector3d::UnitZ());
    sums.A.diagonal().array() += 1.0;
    const Vector6d step = -sums.A.ldlt().solve(sums.b);
    if (!step.allFinite()) return;
    T.R = orthonormalized(T.R * Exp(step.head<3>()));
    T.p += step.tail<3>();
    if (step.cwiseAbs().maxCoeff() < kConverged) return;
  }
}

Registration SurfaceRegistration::run(std::span<const Surfel> query, const Pose& T_candidate_query) const {
  Registration out;
  out.T_candidate_query = T_candidate_query;
  const std::vector<Surfel> coarse = thin_surfels(query, config_.coarse_voxel_m);
  iterate(coarse, {&coarse_, config_.coarse_reach_m}, out);
  iterate(coarse, {&coarse_, config_.coarse_reach_m / 2}, out);
  iterate(query, {&fine_, config_.fine_reach_m}, out);
  iterate(query, {&fine_, config_.fine_reach_m / 2}, out);
  return out;
}

}  // namespace lxd
