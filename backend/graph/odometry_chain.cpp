// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/odometry_chain.hpp"

#include "rt/square.hpp"

namespace lxd {
namespace {

// A key frame that did not move is still not known better than this against the one before.
constexpr double kRestSigma_m = 2e-3, kRestSigma_rad = 2e-4;

}  // namespace

Matrix6d OdometryChain::drift(const KeyFrame& key_frame) const {
  const double position_m2 = square(kRestSigma_m) + square(config_.drift_m_per_sqrt_m) * key_frame.travelled_m;
  const double rotation_rad2 = square(kRestSigma_rad) + square(config_.drift_rad_per_sqrt_m) * key_frame.travelled_m +
                               square(config_.drift_rad_per_sqrt_rad) * key_frame.turned_rad;
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(rotation_rad2), Eigen::Vector3d::Constant(position_m2);
  return variances.asDiagonal();
}

void OdometryChain::add(const KeyFrame& key_frame) {
  if (links_.empty()) {
    links_.push_back({key_frame, {}, {}, 0});
    return;
  }
  const Link& last = links_.back();
  const RelativeMotion step{last.key_frame.T_world_body.inverse() * key_frame.T_world_body,
                            key_frame.motion_covariance + drift(key_frame)};
  links_.push_back({key_frame, step, last.from_first * step, last.path_m + key_frame.travelled_m});
}

RelativeMotion OdometryChain::motion(int i, int j) const {
  const auto from_first = [this](int k) -> const RelativeMotion& {
    return links_[static_cast<std::size_t>(k)].from_first;
  };
  return i <= j ? between(from_first(i), from_first(j)) : inverse_of(between(from_first(j), from_first(i)));
}

}  // namespace lxd
