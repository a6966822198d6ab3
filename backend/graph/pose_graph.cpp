// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/pose_graph.hpp"

#include <algorithm>

#include "backend/graph/gnss_terms.hpp"

namespace lxd {
namespace {

constexpr int kWindow = 40;         // key frames
constexpr int kFixesForWindow = 4;  // fixes that are worth a solution of the window
// On the way the next solution begins where this one ended; in the end poses are within micrometres of the best.
constexpr SolverEffort kOnTheWay{6, 1e-4}, kInTheEnd{100, 1e-9};

}  // namespace

void PoseGraph::add(const KeyFrame& key_frame) {
  GraphState& s = state_;
  s.chain.add(key_frame);
  const int i = s.chain.size() - 1;
  s.poses.push_back(i > 0 && s.constrained() ? s.poses.back() * s.chain.step(i).T : key_frame.T_world_body);
  if (s.sub_meshes.empty() || s.sub_meshes.back().id != key_frame.sub_mesh)
    s.sub_meshes.push_back({key_frame.sub_mesh, i, s.poses.back()});
  s.sub_mesh_of.push_back(static_cast<int>(s.sub_meshes.size()) - 1);
}

void PoseGraph::add(const LoopMeasurement& loop) {
  if (!state_.loops.add(loop)) return;
  state_.closed = state_.loops.accepted();
  loops_new_ = anything_new_ = true;
}

void PoseGraph::add(const PlaceMeasurement& place) {
  if (!state_.places.add(place)) return;
  const bool was_placed = !state_.placed.empty();
  const int map = was_placed ? state_.placed.front().map : 0;
  std::vector<PlaceMeasurement> places = state_.places.accepted();
  if (places.empty()) return;
  const auto stays = [&](const PlaceMeasurement& old) {
    return std::ranges::any_of(places, [&](const auto& now) { return now.key_frame == old.key_frame; });
  };
  const bool elsewhere = was_placed && (places.front().map != map || std::ranges::none_of(state_.placed, stays));
  state_.placed = std::move(places);
  if (!was_placed || elsewhere) enter(state_.placed.front());
  loops_new_ = anything_new_ = true;
}

// The whole path as one, so that the solution begins near where it ends.
void PoseGraph::enter(const PlaceMeasurement& place) {
  move_map(place.T_map_body * T_map_body(static_cast<int>(place.key_frame)).inverse(), state_);
}

void PoseGraph::add(const GnssMeasurement& measurement) {
  const bool was_aligned = state_.gnss.aligned();
  if (!state_.gnss.add(measurement, [this](std::int64_t i) { return T_map_body(static_cast<int>(i)); })) return;
  ++fixes_new_;
  anything_new_ = true;
  if (!was_aligned) lay_on_earth(kOnTheWay);
}

// A solution of n poses is due when n poses' work has been saved up: each key frame brings the same, so that the mean
// work is the same for each, however many there are.
void PoseGraph::update() {
  credit_ = std::min(credit_ + state_.config.work_per_key_frame, nodes());
  if (!state_.constrained()) {
    if (anything_new_) rest_on_odometry();
    return;
  }
  if (anything_new_ && credit_ >= nodes()) {
    credit_ = 0;
    solve_whole(kOnTheWay);
  } else if (loops_new_ && credit_ >= static_cast<int>(state_.sub_meshes.size())) {
    credit_ -= static_cast<int>(state_.sub_meshes.size());
    solve_sub_meshes();
  } else if (state_.bent_by_fixes() && fixes_new_ >= kFixesForWindow) {
    solve_window();
  }
}

void PoseGraph::finish() {
  if (!state_.constrained()) return rest_on_odometry();
  state_.learnt_from = 0;  // the last word is that of all fixes
  solve_whole(kInTheEnd);
  const auto pose = [this](std::int64_t i) { return T_map_body(static_cast<int>(i)); };
  if (state_.gnss.aligned() && state_.gnss.drop_outliers(pose)) solve_whole(kInTheEnd);
}

void PoseGraph::solve_whole(const SolverEffort& effort) {
  learn_noise_levels(state_);
  if (state_.bent_by_places() || state_.bent_by_fixes()) {
    GraphProblem problem = whole_problem(state_);
    if (solve(problem, effort).usable) take_whole(problem, state_);
  } else {
    rest_on_odometry();
  }
  if (!state_.bent_by_fixes()) lay_on_earth(effort);
  loops_new_ = anything_new_ = false;
  fixes_new_ = 0;
  ++work_.whole;
}

void PoseGraph::solve_sub_meshes() {
  GraphProblem problem = sub_mesh_problem(state_);
  if (solve(problem, kOnTheWay).usable) take_sub_meshes(problem, state_);
  loops_new_ = false;
  ++work_.sub_meshes;
}

void PoseGraph::solve_window() {
  const int first = std::max(0, state_.size() - kWindow);
  GraphProblem problem = window_problem(state_, first);
  if (solve(problem, kOnTheWay).usable) take_window(problem, first, state_);
  fixes_new_ = 0;
  ++work_.windows;
}

// All loops may have been found wrong again.
void PoseGraph::rest_on_odometry() {
  for (int i = 0; i < state_.size(); ++i) state_.poses[static_cast<std::size_t>(i)] = state_.chain[i].T_world_body;
  for (SubMeshNode& sub_mesh : state_.sub_meshes)
    sub_mesh.T_map = state_.poses[static_cast<std::size_t>(sub_mesh.first)];
  loops_new_ = anything_new_ = false;
  fixes_new_ = 0;
}

// Turns the whole path and finds its place on the earth, as far as fixes have shown that.
void PoseGraph::lay_on_earth(const SolverEffort& effort) {
  if (!state_.gnss.aligned()) return;
  GraphProblem problem = rigid_problem(state_);
  if (solve(problem, effort).usable) take_rigid(problem, state_);
}

Pose PoseGraph::correction_at(int i) const {
  return constrained() ? T_map_body(i) * state_.chain[i].T_world_body.inverse() : Pose();
}

std::optional<Pose> PoseGraph::sub_mesh_correction(std::int64_t sub_mesh) const {
  const auto found = std::ranges::lower_bound(state_.sub_meshes, sub_mesh, {}, &SubMeshNode::id);
  if (found == state_.sub_meshes.end() || found->id != sub_mesh) return std::nullopt;
  return constrained() ? found->T_map * state_.chain[found->first].T_world_body.inverse() : Pose();
}

}  // namespace lxd
