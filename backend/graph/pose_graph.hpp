// SPDX-License-Identifier: Apache-2.0
// The factor graph of the back-end (paper, "Backend: Robust Loop Closure and Joint Optimization"): key frames and
// sub-meshes, odometry, loops and GNSS. A plain object: whoever owns it calls it from one low-priority thread. The same
// calls in the same order give the same poses.
#pragma once

#include <optional>
#include <span>

#include "backend/graph/graph_state.hpp"

namespace lxd {

struct GraphWork {
  std::uint64_t whole = 0, sub_meshes = 0, windows = 0;  // solutions
};

class PoseGraph {
 public:
  explicit PoseGraph(const GraphConfig& config) : state_(config) {}

  void add(const KeyFrame& key_frame);
  void add(const LoopMeasurement& loop);
  // Once such agree, the map's frame is that of the map that they were found in, whose poses stay as they are.
  void add(const PlaceMeasurement& place);
  void add(const GnssMeasurement& measurement);

  // Solves as much as is due: after each key frame and what was measured at it. The time it takes is bounded for each
  // key frame, averaged over the last few, however long the way has been.
  void update();
  // Solves all to the end, leaves out what does not fit the solution, and solves again.
  void finish();

  // Whether anything but odometry has a part in the poses. Without, they are odometry's to the last bit.
  [[nodiscard]] bool constrained() const { return state_.constrained(); }
  [[nodiscard]] int size() const { return state_.size(); }
  [[nodiscard]] const KeyFrame& key_frame(int i) const { return state_.chain[i]; }
  [[nodiscard]] const Pose& T_map_body(int i) const { return state_.poses[static_cast<std::size_t>(i)]; }
  // At the last key frame; there is one.
  [[nodiscard]] Pose T_map_world() const { return correction_at(size() - 1); }
  [[nodiscard]] Pose correction_at(int key_frame) const;
  // T_map_world for the surfaces of a sub-mesh. None: no key frame belongs to it.
  [[nodiscard]] std::optional<Pose> sub_mesh_correction(std::int64_t sub_mesh) const;

  // The loops that are believed, with the covariance that they have at least.
  [[nodiscard]] std::span<const LoopMeasurement> loops() const { return state_.closed; }
  // The places that are believed, all in one finished map; none: the map begins where this path does.
  [[nodiscard]] std::span<const PlaceMeasurement> places() const { return state_.placed; }
  [[nodiscard]] PlaceCounts place_counts() const { return state_.places.counts(); }
  [[nodiscard]] LoopCounts loop_counts() const { return state_.loops.counts(); }
  [[nodiscard]] GnssCounts gnss_counts() const { return state_.gnss.counts(); }
  [[nodiscard]] const GnssTrack& gnss() const { return state_.gnss; }
  // What fixes told of odometry and of themselves. None: too few of them.
  [[nodiscard]] const std::optional<NoiseLevels>& noise() const { return state_.noise; }
  [[nodiscard]] const GraphWork& work() const { return work_; }
  // Of all factors at the poses as they are.
  [[nodiscard]] double cost() const { return cost_of(whole_problem(state_)); }

 private:
  [[nodiscard]] int nodes() const { return state_.size() + static_cast<int>(state_.sub_meshes.size()); }
  void solve_whole(const SolverEffort& effort);
  void solve_sub_meshes();
  void solve_window();
  void rest_on_odometry();
  void lay_on_earth(const SolverEffort& effort);
  void enter(const PlaceMeasurement& place);

  GraphState state_;
  GraphWork work_;
  int credit_ = 0;             // poses that may be solved
  bool loops_new_ = false;     // since sub-meshes or all were solved
  bool anything_new_ = false;  // since all were solved
  int fixes_new_ = 0;          // since the last solution of any kind
};

}  // namespace lxd
