// SPDX-License-Identifier: Apache-2.0
// Where a mover is at a time, and whether a ray meets it there.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

// Upright; turned about z into the direction of the way.
struct MoverPose {
  Eigen::Vector3f centre_m = Eigen::Vector3f::Zero();
  Eigen::Vector2f heading = Eigen::Vector2f::UnitX();  // unit

  [[nodiscard]] Eigen::Vector3f to_local(const Eigen::Vector3f& world_direction) const;
  [[nodiscard]] Eigen::Vector3f to_world(const Eigen::Vector3f& local_direction) const;
};

struct BoxHit {
  float range_m;
  Eigen::Vector3f normal;  // of the side that was entered, world
  Eigen::Vector3f local_m;
  Eigen::Vector3f local_normal;
};

class MoverTrack {
 public:
  // Keeps a reference. A way that ends where it began is a loop; any other is walked forth and back.
  explicit MoverTrack(const Mover& mover);

  [[nodiscard]] MoverPose at(float t_s) const;
  [[nodiscard]] float radius_m() const { return mover_.half_m.norm(); }
  [[nodiscard]] const Mover& mover() const { return mover_; }
  // None when the ray passes by, or begins within: nobody sees the world from inside a person.
  [[nodiscard]] std::optional<BoxHit> entered_by(const Eigen::Vector3f& origin_m, const Eigen::Vector3f& direction,
                                                 float t_s) const;

 private:
  const Mover& mover_;
  std::vector<double> arc_m_;  // as the way's points
  bool loop_ = false;
};

}  // namespace lxd::sim
