// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/gnss_terms.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr double kKernel_sigmas = 2;
constexpr double kKnot_s = 2;
constexpr double kFixesApartMin_s = 0.01;  // between fixes
constexpr double kLearnAgain = 1.1;        // when there are so many times as many fixes as when it was last done
constexpr std::size_t kStride = 5;         // of the fixes, those that the sub-meshes alone are solved with

struct Knot {
  std::size_t index;
  double toward;  // of the way to the next
};

Knot knot_of(const GraphState& state, const GnssMeasurement& fix) {
  const double at = (fix.stamp - state.gnss.began()).seconds() / kKnot_s;
  const double index = std::floor(at);
  return {static_cast<std::size_t>(index), at - index};
}

double correlation_s(const GraphState& state) {
  return state.noise ? state.noise->correlation_s : state.config.gnss_correlation_s;
}

Eigen::Matrix3d sqrt_information_of_fix(const Eigen::Matrix3d& covariance) {
  return covariance.llt().solve(Eigen::Matrix3d::Identity()).llt().matrixU();
}

double white_share(const GraphState& state) { return state.noise.value_or(NoiseLevels{}).white_share; }

// What lasts of a fix's variance from knot to knot: that of the error's mean over the time between them. Errors shorter
// than that are as good as white.
double share_at_knots(const GraphState& state) {
  const double x = kKnot_s / correlation_s(state);
  return (1 - white_share(state)) * 2 * (x - 1 + std::exp(-x)) / (x * x);
}

GnssFactor factor_of(const GraphState& state, const GnssMeasurement& m) {
  const double share = share_at_knots(state);
  const Eigen::Matrix3d L = (share * m.covariance_m2).llt().matrixL();
  Eigen::Matrix3d white_m2 = (1 - share) * m.covariance_m2;
  if (state.noise) {
    const Eigen::Matrix3d& R_map_body = state.poses[static_cast<std::size_t>(m.key_frame)].R;
    const Eigen::Matrix3d R_enu_map = Exp(Eigen::Vector3d(0, 0, state.gnss.alignment().yaw_rad));
    const Eigen::Vector3d shaken_m = state.noise->jitter_s * (R_enu_map * (R_map_body * m.antenna_velocity_mps));
    white_m2 += shaken_m * shaken_m.transpose();
  }
  return {m.antenna_body_m, m.antenna_velocity_mps, m.enu_m, L, sqrt_information_of_fix(white_m2)};
}

// Errors that last for a time tau: of fixes dt apart, 2 tau / dt are worth one.
GnssFactor coarse_factor_of(const GnssMeasurement& m, double alike, const Pose& T_sub_mesh_body) {
  return {T_sub_mesh_body * m.antenna_body_m, T_sub_mesh_body.R * m.antenna_velocity_mps, m.enu_m,
          Eigen::Matrix3d::Zero(), sqrt_information_of_fix(alike * m.covariance_m2)};
}

void set_alignment(const GraphState& state, GraphProblem& problem) {
  problem.alignment = state.gnss.alignment();
  problem.delay_expected_s = state.config.gnss_delay_s;
  problem.delay_sigma_s = state.config.gnss_delay_sigma_s;
}

std::span<const GnssMeasurement> fixes_from(const GraphState& state, int first) {
  const auto& fixes = state.gnss.fixes();
  return {std::ranges::lower_bound(fixes, first, {}, &GnssMeasurement::key_frame), fixes.end()};
}

}  // namespace

void learn_noise_levels(GraphState& state) {
  const auto& fixes = state.gnss.fixes();
  if (!state.gnss.aligned() || static_cast<double>(fixes.size()) < kLearnAgain * static_cast<double>(state.learnt_from))
    return;
  state.learnt_from = fixes.size();
  const EarthAlignment& earth = state.gnss.alignment();
  const Pose T_enu_map{Exp(Eigen::Vector3d(0, 0, earth.yaw_rad)), earth.offset_m};
  const Pose T_enu_world = T_enu_map * state.poses.front() * state.chain[0].T_world_body.inverse();
  state.noise = find_noise_levels(state.chain, fixes, T_enu_world, earth.delay_s, state.config.gnss_delay_sigma_s);
}

void add_fixes(const GraphState& state, int first, GraphProblem& problem) {
  if (!state.gnss.aligned()) return;
  set_alignment(state, problem);
  const auto fixes = fixes_from(state, first);
  if (fixes.empty()) return;
  const std::size_t begin = first > 0 ? knot_of(state, fixes.front()).index : 0;
  for (const GnssMeasurement& fix : fixes) {
    const Knot knot = knot_of(state, fix);
    problem.gnss.push_back({static_cast<int>(fix.key_frame) - first, factor_of(state, fix), kKernel_sigmas,
                            knot.index - begin, knot.toward});
  }
  const std::size_t end = knot_of(state, fixes.back()).index + 2;
  for (std::size_t k = begin; k < end; ++k)
    problem.lasting.push_back(k < state.lasting.size() ? state.lasting[k] : Eigen::Vector3d(Eigen::Vector3d::Zero()));
  problem.lasting_factor = {std::exp(-kKnot_s / correlation_s(state))};
  problem.first_lasting_held = first > 0;
}

void take_lasting(const GraphProblem& solved, int first, GraphState& state) {
  const auto fixes = fixes_from(state, first);
  if (solved.gnss.empty() || fixes.empty()) return;
  const std::size_t begin = first > 0 ? knot_of(state, fixes.front()).index : 0;
  state.lasting.resize(std::max(state.lasting.size(), begin + solved.lasting.size()), Eigen::Vector3d::Zero());
  std::ranges::copy(solved.lasting, state.lasting.begin() + static_cast<std::ptrdiff_t>(begin));
}

void add_coarse_fixes(const GraphState& state, GraphProblem& problem) {
  const auto& fixes = state.gnss.fixes();
  if (!state.gnss.aligned()) return;
  set_alignment(state, problem);
  problem.lasting.assign(2, Eigen::Vector3d::Zero());
  problem.first_lasting_held = true;
  for (std::size_t i = 0; i < fixes.size(); i += kStride) {
    const GnssMeasurement& fix = fixes[i];
    const auto at = static_cast<int>(fix.key_frame);
    const int node = state.sub_mesh_of[static_cast<std::size_t>(at)];
    const double since_s = i > 0 ? (fix.stamp - fixes[i - kStride].stamp).seconds() : correlation_s(state);
    const double alike = std::max(1.0, 2 * correlation_s(state) / std::max(kFixesApartMin_s, since_s));
    const int begin = state.sub_meshes[static_cast<std::size_t>(node)].first;
    problem.gnss.push_back(
        {node, coarse_factor_of(fix, alike, state.chain.motion(begin, at).T), kKernel_sigmas / std::sqrt(alike), 0, 0});
  }
}

}  // namespace lxd
