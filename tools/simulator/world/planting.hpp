// SPDX-License-Identifier: Apache-2.0
// Things outdoors, put where the site has room for them: each says whether it stands.
#pragma once

#include "tools/simulator/world/facade.hpp"
#include "tools/simulator/world/ground.hpp"
#include "tools/simulator/world/site.hpp"

namespace lxd::sim {

class Planting {
 public:
  Planting(Site& site, const Ground& ground) : site_(site), ground_(ground) {}

  bool tree(const Eigen::Vector2d& at, double scale);
  bool lamp_post(const Eigen::Vector2d& at, double yaw_rad);
  bool sign(const Eigen::Vector2d& at, double yaw_rad);
  bool car(const Eigen::Vector2d& at, double yaw_rad);
  bool hedge(const Eigen::Vector2d& at, double yaw_rad, double length_m);
  bool wall(const Eigen::Vector2d& at, double yaw_rad, double length_m, double height_m, Surface surface);
  bool bench(const Eigen::Vector2d& at, double yaw_rad);
  bool house(const House& wanted, double gap_m);

  // Anywhere within, evenly.
  Eigen::Vector2d somewhere(const Eigen::Vector2d& low, const Eigen::Vector2d& high);

 private:
  [[nodiscard]] Placement on_ground(const Eigen::Vector2d& at, double yaw_rad) const {
    return {ground_.on(at), yaw_rad};
  }
  [[nodiscard]] Footprint standing(const Eigen::Vector2d& at, const Eigen::Vector2d& half_m, double yaw_rad,
                                   double height_m) const;

  Site& site_;
  const Ground& ground_;
};

}  // namespace lxd::sim
