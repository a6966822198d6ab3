// SPDX-License-Identifier: Apache-2.0
// Which of the filter's poses the back-end keeps: after so much way, turn or time, and whenever a sub-mesh begins.
#pragma once

#include <optional>

#include "backend/graph/config.hpp"
#include "estimator/sweep_outcome.hpp"
#include "rt/key_frame.hpp"

namespace lxd {

class KeyFrameCutter {
 public:
  explicit KeyFrameCutter(const GraphConfig& config) : config_(config) {}

  // One sweep that the filter took; `sub_mesh_begin` is the stamp of the first sweep of the sub-mesh that it went into,
  // `up_world` where gravity comes from, if that was felt. The key frame, if this sweep is one.
  std::optional<KeyFrame> take(const SweepOutcome& outcome, RigTime sub_mesh_begin,
                               const std::optional<Eigen::Vector3d>& up_world);

  // The last that was cut; there is one after the first sweep.
  [[nodiscard]] const std::optional<KeyFrame>& last() const { return last_; }

 private:
  [[nodiscard]] bool due(RigTime stamp, bool new_sub_mesh) const;

  GraphConfig config_;
  std::optional<KeyFrame> last_;
  Eigen::Matrix<double, 6, 6> last_covariance_ = Eigen::Matrix<double, 6, 6>::Zero();  // of its T_world_body
  Pose previous_;                                                                      // sweep's
  RigTime sub_mesh_begin_;
  double travelled_m_ = 0, turned_rad_ = 0;  // since the last key frame
};

}  // namespace lxd
