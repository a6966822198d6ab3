// SPDX-License-Identifier: Apache-2.0
// Returns from the walls of a box room whose noise is known, and an update of the filter with them: no map, so that the
// filter alone answers for what comes out.
#pragma once

#include <vector>

#include "estimator/ieskf.hpp"
#include "tests/support/estimator_states.hpp"

namespace lxd::test {

inline constexpr double kSpan_s = 0.1;
inline constexpr float kSigma_m = 0.02F;
inline constexpr double kWide = 1e9;  // sigmas: a kernel that weighs every residual by one
inline constexpr ConstantVelocityNoise kNoise{1.0, 2.0};
inline const Eigen::Vector3d kHalf_m{5, 4, 1.5};  // of the room

// A return from a wall of the room: where the wall is, and what the sensor said.
struct WallReturn {
  Eigen::Vector3f n;  // inwards
  double d_m;
  double tau_s;
  RegistrationPoint point;
};

// Returns of a sweep whose end state is `truth`, each with the noise `sigma_m` along its wall's normal.
inline std::vector<WallReturn> wall_sweep(const State& truth, int count, double sigma_m, StateChance& chance) {
  std::vector<WallReturn> out;
  for (int i = 0; i < count; ++i) {
    const int axis = i % 3;
    const double side = i % 2 == 0 ? 1 : -1;
    Eigen::Vector3d world =
        kHalf_m.cwiseProduct(Eigen::Vector3d(chance.uniform(-1, 1), chance.uniform(-1, 1), chance.uniform(-1, 1)));
    world[axis] = side * (kHalf_m[axis] + chance.normal(sigma_m));
    const double tau = chance.uniform(0, kSpan_s);
    const PathKnot k = SweepPath::knot(truth, tau);
    const Eigen::Vector3d n = -side * Eigen::Vector3d::Unit(axis);
    out.push_back({n.cast<float>(), kHalf_m[axis], tau, {k.R.transpose() * (world - k.p), 0, kSigma_m * kSigma_m}});
  }
  return out;
}

inline std::vector<PointResidual> residuals_at(const State& x, const std::vector<WallReturn>& returns) {
  std::vector<PointResidual> out;
  for (const WallReturn& w : returns) {
    const PathKnot k = SweepPath::knot(x, w.tau_s);
    const double r = w.n.cast<double>().dot(k.R * w.point.p_body_m + k.p) + w.d_m;
    out.push_back(point_to_surface(w.point, k, {0, 0, w.n}));
    out.back().r_m = r;
  }
  return out;
}

inline NormalEquations plain(const std::vector<PointResidual>& rs, int) { return accumulate(rs, 1, kWide); }

template <typename Sum>
bool update(Ieskf& filter, const std::vector<WallReturn>& returns, Sum&& sum, int iterations = 10) {
  filter.begin_update();
  for (int i = 0; i < iterations; ++i) filter.iterate(sum(residuals_at(filter.state(), returns), i));
  return filter.conclude();
}

inline StateMatrix prior_covariance(double turn_rad, double shift_m, double speed_mps, double rate_radps) {
  StateMatrix P = StateMatrix::Zero();
  const auto set = [&](int block, double sigma) { P.diagonal().segment<3>(block).setConstant(sigma * sigma); };
  set(kTheta, turn_rad);
  set(kPosition, shift_m);
  set(kVelocity, speed_mps);
  set(kGyroBias, rate_radps);
  return P;
}

// A carrier in the middle of the room, walking and turning.
inline State carrier(StateChance& chance) {
  State x;
  x.R = Exp(chance.vector(1));
  x.p = chance.vector(0.3);
  x.v = chance.vector(1);
  x.b_g = chance.vector(0.3);
  return x;
}

}  // namespace lxd::test
