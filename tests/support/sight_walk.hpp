// SPDX-License-Identifier: Apache-2.0
// A path past places that look unlike each other, some of which are seen again: each place is a scene of its own, seen
// from two sides. What a finder of loops by sight is told.
#pragma once

#include <optional>

#include "backend/sight/sight_finder.hpp"
#include "tests/support/sight_scene.hpp"

namespace lxd::test {

class SightWalk {
 public:
  explicit SightWalk(const SightFinderConfig& config = {}) : finder(config) {}

  // Walks on to a new place. Its scene is told by its number.
  std::optional<LoopMeasurement> pass(unsigned place) {
    path_m_ += kStep_m;
    return look(SightScene({.turn_rad = kTurn_rad}, place).historical, pose_of(place));
  }
  // Comes to a place again; the filter has drifted by so much meanwhile.
  std::optional<LoopMeasurement> return_to(unsigned place, const Eigen::Vector3d& drift_m = Eigen::Vector3d::Zero()) {
    path_m_ += kStep_m;
    const SightScene scene({.turn_rad = kTurn_rad}, place);
    Pose T = pose_of(place) * scene.T_from_to();
    T.p += drift_m;
    return look(scene.current, T);
  }
  std::optional<LoopMeasurement> look(VisualKeyFrame frame, const Pose& T_world_body) {
    frame.id = next_++;
    return finder.look(std::move(frame), {T_world_body, path_m_, static_cast<std::int64_t>(path_m_ / kSubmesh_m)});
  }
  // Past so many places, none of them like another.
  void pass_some(unsigned first, unsigned count) {
    for (unsigned i = first; i < first + count; ++i) pass(i);
  }

  [[nodiscard]] static Pose pose_of(unsigned place) { return {Eigen::Matrix3d::Identity(), {kStep_m * place, 0, 0}}; }
  [[nodiscard]] static Pose true_loop(unsigned place) { return SightScene({.turn_rad = kTurn_rad}, place).T_from_to(); }

  SightFinder finder;

  static constexpr double kStep_m = 10, kSubmesh_m = 40, kTurn_rad = 0.3;

 private:
  double path_m_ = 0;
  std::int64_t next_ = 0;
};

}  // namespace lxd::test
