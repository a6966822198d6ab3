// SPDX-License-Identifier: Apache-2.0
// What the solved graph says of everything between its key frames: poses of the filter's path, and sub-meshes.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "backend/graph/pose_graph.hpp"

namespace lxd {

class CorrectedPath {
 public:
  // Takes over a solved graph. A second graph is of a later part of the path, with a world of its own. `map`: whose
  // frame its poses are in.
  void add(const PoseGraph& graph, int map = 0);
  // The map that the run's files are of; parts of the path in others are apart from it.
  void set_main(int map) { main_ = map; }

  // Whether anything is other than odometry has it.
  [[nodiscard]] bool moved() const { return moved_; }
  // T_map_x of a frame x that rides on the body, from T_world_x at that time. Between key frames it goes from what the
  // one before says to what the one after says.
  [[nodiscard]] Pose correct(RigTime stamp, const Pose& T_world_x) const;
  [[nodiscard]] int main() const { return main_; }
  // Which piece a pose or a sub-mesh, begun by the sweep with this stamp, belongs to. 0: the run's map.
  [[nodiscard]] std::int64_t piece(RigTime stamp) const;
  [[nodiscard]] bool in_pieces() const;  // not all is in the run's map
  // T_map_world of the sub-mesh whose first sweep has this stamp.
  [[nodiscard]] std::optional<Pose> sub_mesh(RigTime begin) const;

  // The sweep with this stamp has begun this sub-mesh.
  void note_sub_mesh(RigTime begin, std::int64_t id) { begun_[begin] = id; }
  // The one that it has begun, of the graph to come.
  [[nodiscard]] std::optional<std::int64_t> sub_mesh_id(RigTime begin) const;

 private:
  struct Knot {
    RigTime stamp;
    Pose T_map_world;
    bool first;  // of its graph
    int map;
  };
  std::vector<Knot> knots_;
  std::map<RigTime, std::int64_t> begun_;  // of the graph to come
  std::map<RigTime, Pose> sub_meshes_;     // T_map_world
  bool moved_ = false;
  int main_ = 0;
};

}  // namespace lxd
