// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/fix_filter.hpp"

namespace lxd {

std::vector<FixStep> steps_of(const OdometryChain& chain, std::span<const GnssMeasurement> fixes,
                              const Pose& T_enu_world, double delay_s) {
  std::vector<FixStep> steps;
  Eigen::Vector3d last_m = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const GnssMeasurement &fix = fixes[i], &before = fixes[i > 0 ? i - 1 : 0];
    const int a = static_cast<int>(before.key_frame), b = static_cast<int>(fix.key_frame);
    const Pose T_enu_b = T_enu_world * chain[b].T_world_body;
    const Eigen::Vector3d at_m = T_enu_b * (fix.antenna_body_m - delay_s * fix.antenna_velocity_mps);
    Matrix6d to_enu = Matrix6d::Zero();  // rotations come in axes of b, positions in those of a
    to_enu.topLeftCorner<3, 3>() = T_enu_b.R;
    to_enu.bottomRightCorner<3, 3>() = T_enu_world.R * chain[a].T_world_body.R;
    const Eigen::Vector3d moved_m = i > 0 ? Eigen::Vector3d(at_m - last_m) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    steps.push_back({moved_m, to_enu * chain.motion(a, b).covariance * to_enu.transpose(),
                     (fix.stamp - before.stamp).seconds(), fix.enu_m - at_m, fix.covariance_m2,
                     T_enu_b.R * fix.antenna_velocity_mps});
    last_m = at_m;
  }
  return steps;
}

}  // namespace lxd
