// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/graph_state.hpp"

#include <algorithm>
#include <cmath>

#include "backend/graph/gnss_terms.hpp"
#include "backend/graph/pose_blend.hpp"

namespace lxd {
namespace {

constexpr double kLoopKernel_sigmas = 2;
// A key frame lies in its sub-mesh as well as a sweep registers.
constexpr double kRegistrationSigma_m = 0.02, kRegistrationSigma_rad = 2e-3;

// The map begins where the world does. What is up is the world's own guess, and others know it better: an IMU, or
// fixes.
constexpr double kAnchorSigma_m = 1e-3, kAnchorSigma_rad = 1e-4, kAnchorTiltSigma_rad = 0.1;

AnchorFactor anchor_of(const GraphState& state) {
  const bool tilts = state.gnss.aligned() || state.chain[0].up_body.has_value();
  const double tilt = tilts ? kAnchorTiltSigma_rad : kAnchorSigma_rad;
  Vector6d sigmas;
  sigmas << tilt, tilt, kAnchorSigma_rad, Eigen::Vector3d::Constant(kAnchorSigma_m);
  return {state.chain[0].T_world_body, sigmas};
}

GraphProblem::Relative relative(int a, int b, const RelativeMotion& motion, double robust = 0) {
  return {a, b, {motion.T, sqrt_information(motion.covariance)}, robust};
}

// As well as the fixes show that it is known.
RelativeMotion motion_between(const GraphState& state, int a, int b) {
  RelativeMotion motion = b == a + 1 ? state.chain.step(b) : state.chain.motion(a, b);
  if (state.bent_by_fixes())
    motion.covariance = scaled(motion, state.poses[static_cast<std::size_t>(a)].R, *state.noise);
  return motion;
}

RelativeMotion with_registration(RelativeMotion motion) {
  motion.covariance.diagonal().head<3>().array() += kRegistrationSigma_rad * kRegistrationSigma_rad;
  motion.covariance.diagonal().tail<3>().array() += kRegistrationSigma_m * kRegistrationSigma_m;
  return motion;
}

// What an accelerometer is wrong by lasts: of vertical directions dt apart, 2 tau / dt are worth one.
void add_tilt(const GraphState& state, int before, int key_frame, int node, GraphProblem& problem) {
  constexpr double kBiasLasts_s = 100, kShortest_s = 0.01;
  const auto& up = state.chain[key_frame].up_body;
  if (!up) return;
  const double since_s = (state.chain[key_frame].stamp - state.chain[before].stamp).seconds();
  const double alike = before == key_frame ? 1.0 : std::max(1.0, 2 * kBiasLasts_s / std::max(kShortest_s, since_s));
  problem.tilt.push_back({node, {*up, state.config.tilt_sigma_rad * std::sqrt(alike)}});
}

RelativeMotion motion_of(const LoopMeasurement& loop) { return {loop.T_from_to, loop.covariance}; }

// A map that is finished: everything that was found in it is seen from its zero. The anchor is then this.
int add_finished_map(GraphProblem& problem) {
  problem.anchor.reset();
  problem.held.resize(problem.poses.size(), false);
  problem.poses.emplace_back();
  problem.held.push_back(true);
  return static_cast<int>(problem.poses.size()) - 1;
}

// Of the key frames from `first` on, which are the first nodes.
void add_places(const GraphState& state, int first, GraphProblem& problem) {
  if (state.placed.empty()) return;
  const int zero = add_finished_map(problem);
  for (const PlaceMeasurement& place : state.placed)
    if (place.key_frame >= first)
      problem.relative.push_back(relative(zero, static_cast<int>(place.key_frame) - first,
                                          {place.T_map_body, place.covariance}, kLoopKernel_sigmas));
}

// Sub-mesh to key frame.
RelativeMotion within(const GraphState& state, int key_frame) {
  const auto m = static_cast<std::size_t>(state.sub_mesh_of[static_cast<std::size_t>(key_frame)]);
  return motion_between(state, state.sub_meshes[m].first, key_frame);
}

}  // namespace

void move_map(const Pose& T_new_old, GraphState& state) {
  for (Pose& T : state.poses) T = T_new_old * T;
  for (SubMeshNode& sub_mesh : state.sub_meshes) sub_mesh.T_map = T_new_old * sub_mesh.T_map;
  if (!state.gnss.aligned()) return;
  EarthAlignment earth = state.gnss.alignment();
  earth.yaw_rad -= std::atan2(T_new_old.R(1, 0), T_new_old.R(0, 0));
  const Eigen::Vector3d zero_enu_m = earth.offset_m;  // where the old frame's zero is
  earth.offset_m.setZero();
  earth.offset_m = zero_enu_m - earth.to_enu(T_new_old.p);
  state.gnss.set_alignment(earth);
}

GraphProblem whole_problem(const GraphState& state) {
  GraphProblem problem;
  const int n = state.size();
  problem.poses = state.poses;
  for (const SubMeshNode& sub_mesh : state.sub_meshes) problem.poses.push_back(sub_mesh.T_map);
  problem.anchor = anchor_of(state);
  for (int i = 0; i < n; ++i) {
    if (i > 0) problem.relative.push_back(relative(i - 1, i, motion_between(state, i - 1, i)));
    const int node = n + state.sub_mesh_of[static_cast<std::size_t>(i)];
    problem.relative.push_back(relative(node, i, with_registration(within(state, i))));
    add_tilt(state, std::max(0, i - 1), i, i, problem);
  }
  for (const LoopMeasurement& loop : state.closed)
    problem.relative.push_back(
        relative(static_cast<int>(loop.from), static_cast<int>(loop.to), motion_of(loop), kLoopKernel_sigmas));
  add_places(state, 0, problem);
  if (state.bent_by_fixes()) add_fixes(state, 0, problem);
  return problem;
}

void take_whole(const GraphProblem& solved, GraphState& state) {
  const auto n = static_cast<std::ptrdiff_t>(state.poses.size());
  state.poses.assign(solved.poses.begin(), solved.poses.begin() + n);
  for (std::size_t m = 0; m < state.sub_meshes.size(); ++m)
    state.sub_meshes[m].T_map = solved.poses[state.poses.size() + m];
  if (!solved.gnss.empty()) state.gnss.set_alignment(solved.alignment);
  take_lasting(solved, 0, state);
}

GraphProblem rigid_problem(const GraphState& state) {
  GraphProblem problem;
  problem.poses = {state.poses.front()};
  problem.held = {!state.placed.empty()};
  problem.anchor = anchor_of(state);
  for (int i = 0; i < state.size(); ++i) add_tilt(state, std::max(0, i - 1), i, i, problem);
  add_fixes(state, 0, problem);
  const auto in_first = [&](int i) { return state.poses.front().inverse() * state.poses[static_cast<std::size_t>(i)]; };
  for (auto& [node, tilt] : problem.tilt) {
    tilt.up_body = in_first(node).R * tilt.up_body;
    node = 0;
  }
  for (GraphProblem::Gnss& fix : problem.gnss) {
    const Pose T_first_body = in_first(fix.node);
    fix.factor.antenna_body_m = T_first_body * fix.factor.antenna_body_m;
    fix.factor.antenna_velocity_mps = T_first_body.R * fix.factor.antenna_velocity_mps;
    fix.node = 0;
  }
  return problem;
}

void take_rigid(const GraphProblem& solved, GraphState& state) {
  move_map(solved.poses.front() * state.poses.front().inverse(), state);
  state.gnss.set_alignment(solved.alignment);
  take_lasting(solved, 0, state);
}

GraphProblem window_problem(const GraphState& state, int first) {
  GraphProblem problem;
  problem.poses.assign(state.poses.begin() + first, state.poses.end());
  problem.held.assign(problem.poses.size(), false);
  problem.held.front() = true;
  for (int i = first; i < state.size(); ++i) {
    if (i > first) problem.relative.push_back(relative(i - 1 - first, i - first, motion_between(state, i - 1, i)));
    add_tilt(state, std::max(first, i - 1), i, i - first, problem);
  }
  for (const LoopMeasurement& loop : state.closed) {
    if (loop.to < first) continue;
    int from = static_cast<int>(loop.from) - first;
    if (from < 0) {
      from = static_cast<int>(problem.poses.size());
      problem.poses.push_back(state.poses[static_cast<std::size_t>(loop.from)]);
      problem.held.push_back(true);
    }
    problem.relative.push_back(relative(from, static_cast<int>(loop.to) - first, motion_of(loop), kLoopKernel_sigmas));
  }
  add_places(state, first, problem);
  add_fixes(state, first, problem);
  problem.alignment_held = true;
  return problem;
}

void take_window(const GraphProblem& solved, int first, GraphState& state) {
  take_lasting(solved, first, state);
  const auto begin = static_cast<std::size_t>(first);
  std::copy_n(solved.poses.begin(), state.poses.size() - begin, state.poses.begin() + first);
  for (SubMeshNode& sub_mesh : state.sub_meshes)
    if (sub_mesh.first >= first) sub_mesh.T_map = state.poses[static_cast<std::size_t>(sub_mesh.first)];
}

GraphProblem sub_mesh_problem(const GraphState& state) {
  GraphProblem problem;
  problem.anchor = anchor_of(state);
  for (std::size_t m = 0; m < state.sub_meshes.size(); ++m) {
    const int first = state.sub_meshes[m].first, node = static_cast<int>(m);
    problem.poses.push_back(state.sub_meshes[m].T_map);
    if (m > 0)
      problem.relative.push_back(relative(node - 1, node, motion_between(state, state.sub_meshes[m - 1].first, first)));
    add_tilt(state, m > 0 ? state.sub_meshes[m - 1].first : first, first, node, problem);
  }
  const auto node_of = [&](std::int64_t key_frame) { return state.sub_mesh_of[static_cast<std::size_t>(key_frame)]; };
  for (const LoopMeasurement& loop : state.closed) {
    if (node_of(loop.from) == node_of(loop.to)) continue;
    const RelativeMotion motion = within(state, static_cast<int>(loop.from)) * motion_of(loop) *
                                  inverse_of(within(state, static_cast<int>(loop.to)));
    problem.relative.push_back(relative(node_of(loop.from), node_of(loop.to), motion, kLoopKernel_sigmas));
  }
  if (!state.placed.empty()) {
    const int zero = add_finished_map(problem);
    for (const PlaceMeasurement& place : state.placed) {
      const RelativeMotion motion = RelativeMotion{place.T_map_body, place.covariance} *
                                    inverse_of(within(state, static_cast<int>(place.key_frame)));
      problem.relative.push_back(relative(zero, node_of(place.key_frame), motion, kLoopKernel_sigmas));
    }
  }
  if (state.bent_by_fixes()) add_coarse_fixes(state, problem);
  return problem;
}

void take_sub_meshes(const GraphProblem& solved, GraphState& state) {
  std::vector<Pose> corrections;  // T_new_old of the map
  for (std::size_t m = 0; m < state.sub_meshes.size(); ++m)
    corrections.push_back(solved.poses[m] * state.sub_meshes[m].T_map.inverse());
  for (int i = 0; i < state.size(); ++i) {
    Pose& T = state.poses[static_cast<std::size_t>(i)];
    const auto m = static_cast<std::size_t>(state.sub_mesh_of[static_cast<std::size_t>(i)]);
    const Pose here = corrections[m] * T;
    if (m + 1 == corrections.size()) {
      T = here;
      continue;
    }
    const double begin_m = state.chain.path_m(state.sub_meshes[m].first);
    const double way_m = state.chain.path_m(state.sub_meshes[m + 1].first) - begin_m;
    T = blend(here, corrections[m + 1] * T, way_m > 0 ? (state.chain.path_m(i) - begin_m) / way_m : 0.0);
  }
  for (std::size_t m = 0; m < state.sub_meshes.size(); ++m) state.sub_meshes[m].T_map = solved.poses[m];
  if (!solved.gnss.empty()) state.gnss.set_alignment(solved.alignment);
}

}  // namespace lxd
