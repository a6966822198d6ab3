// SPDX-License-Identifier: Apache-2.0
// What a closed loop says: where a key frame was, seen from an older one. Made by the loop detectors, taken by the
// graph.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "rt/pose.hpp"

namespace lxd {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

struct LoopMeasurement {
  std::int64_t from = 0, to = 0;  // key frames' ids; `from` is the older
  Pose T_from_to;                 // body of `to` in the body of `from`
  // Of T_from_to, perturbed as the filter's pose: [rotation (right: in the axes of `to`), position (axes of `from`)].
  Matrix6d covariance = Matrix6d::Identity();  // rad and m
};

}  // namespace lxd
