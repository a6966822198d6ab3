// SPDX-License-Identifier: Apache-2.0
#include "board/key_frame_cutter.hpp"

#include "backend/graph/relative_motion.hpp"
#include "rt/so3.hpp"

namespace lxd {

bool KeyFrameCutter::due(RigTime stamp, bool new_sub_mesh) const {
  return !last_ || new_sub_mesh || travelled_m_ >= config_.key_frame_distance_m ||
         turned_rad_ >= config_.key_frame_turn_rad || (stamp - last_->stamp).seconds() >= config_.key_frame_time_s;
}

std::optional<KeyFrame> KeyFrameCutter::take(const SweepOutcome& outcome, RigTime sub_mesh_begin,
                                             const std::optional<Eigen::Vector3d>& up_world) {
  const Pose& T = outcome.T_world_body;
  if (last_) {
    travelled_m_ += (T.p - previous_.p).norm();
    turned_rad_ += Log(previous_.R.transpose() * T.R).norm();
  }
  previous_ = T;
  const bool new_sub_mesh = sub_mesh_begin != sub_mesh_begin_;
  if (!due(outcome.stamp, new_sub_mesh)) return std::nullopt;
  KeyFrame frame;
  frame.id = last_ ? last_->id + 1 : 0;
  frame.stamp = outcome.stamp;
  frame.T_world_body = T;
  if (last_)
    frame.motion_covariance = between({last_->T_world_body, last_covariance_}, {T, outcome.covariance}).covariance;
  frame.travelled_m = travelled_m_;
  frame.turned_rad = turned_rad_;
  frame.sub_mesh = last_ ? last_->sub_mesh + new_sub_mesh : 0;
  if (up_world) frame.up_body = (T.R.transpose() * *up_world).normalized();
  last_ = frame;
  last_covariance_ = outcome.covariance;
  sub_mesh_begin_ = sub_mesh_begin;
  travelled_m_ = turned_rad_ = 0;
  return frame;
}

}  // namespace lxd
