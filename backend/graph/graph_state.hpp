// SPDX-License-Identifier: Apache-2.0
// What the graph knows, and the problems that are made of it: all key frames with their sub-meshes, the last few key
// frames, or the sub-meshes alone with everything in them moving as one.
#pragma once

#include <vector>

#include "backend/graph/config.hpp"
#include "backend/graph/gnss_track.hpp"
#include "backend/graph/graph_problem.hpp"
#include "backend/graph/loop_set.hpp"
#include "backend/graph/noise_levels.hpp"
#include "backend/graph/odometry_chain.hpp"
#include "backend/graph/place_set.hpp"

namespace lxd {

// Its frame is the body of its first key frame.
struct SubMeshNode {
  std::int64_t id = 0;
  int first = 0;  // key frame
  Pose T_map;
};

struct GraphState {
  explicit GraphState(const GraphConfig& settings) : config(settings) {}
  GraphState(const GraphState&) = delete;
  GraphState& operator=(const GraphState&) = delete;

  GraphConfig config;
  OdometryChain chain{config};
  std::vector<Pose> poses;       // T_map_body of each key frame
  std::vector<int> sub_mesh_of;  // of each key frame: index in sub_meshes
  std::vector<SubMeshNode> sub_meshes;
  LoopSet loops{config, chain};
  std::vector<LoopMeasurement> closed;  // the loops in use
  PlaceSet places{config, chain};
  std::vector<PlaceMeasurement> placed;  // the places in use: the map's frame is that of the map that they are in
  GnssTrack gnss{config, chain};
  std::optional<NoiseLevels> noise;      // none: as the settings say
  std::size_t learnt_from = 0;           // so many fixes
  std::vector<Eigen::Vector3d> lasting;  // of the fixes' errors: gnss_terms.hpp

  [[nodiscard]] int size() const { return chain.size(); }
  [[nodiscard]] bool constrained() const { return bent_by_places() || gnss.aligned(); }
  // Whether the path's shape is another than odometry's: for loops and places, for fixes.
  [[nodiscard]] bool bent_by_places() const { return !closed.empty() || !placed.empty(); }
  [[nodiscard]] bool bent_by_fixes() const { return gnss.aligned() && noise && noise->drift_shown(); }
};

// All that is known, in another frame of the map. Its tilt against the old one is small.
void move_map(const Pose& T_new_old, GraphState& state);

// Nodes: the key frames, then the sub-meshes. In each problem of several bodies a node at zero follows when places are
// in use: it is held. Fixes are in it where they show that odometry drifts.
GraphProblem whole_problem(const GraphState& state);
void take_whole(const GraphProblem& solved, GraphState& state);

// Nodes: the key frames from `first` on; the first is held, and so is the alignment. Loops that reach beyond hold on to
// where their other end is.
GraphProblem window_problem(const GraphState& state, int first);
void take_window(const GraphProblem& solved, int first, GraphState& state);

// Node: the first key frame, with the whole path as one body; it is held when places are in use. All fixes are in it:
// those that show no drift say where the path lies on the earth, and nothing of its shape.
GraphProblem rigid_problem(const GraphState& state);
void take_rigid(const GraphProblem& solved, GraphState& state);

// Nodes: the sub-meshes.
GraphProblem sub_mesh_problem(const GraphState& state);
// Key frames move with their sub-mesh; between two sub-meshes' beginnings the correction goes from one's to the next's.
void take_sub_meshes(const GraphProblem& solved, GraphState& state);

}  // namespace lxd
