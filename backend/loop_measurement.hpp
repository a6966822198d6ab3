// SPDX-License-Identifier: Apache-2.0
// What a closed loop says: where a key frame was, seen from an older one, or in a map that is finished. Made by the
// loop detectors, taken by the graph.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "rt/pose.hpp"

namespace lxd {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

enum class LoopSense : std::uint8_t { surfaces, sight };

struct LoopMeasurement {
  std::int64_t from = 0, to = 0;  // key frames' ids; `from` is the older
  Pose T_from_to;                 // body of `to` in the body of `from`
  // Of T_from_to, perturbed as the filter's pose: [rotation (right: in the axes of `to`), position (axes of `from`)].
  Matrix6d covariance = Matrix6d::Identity();  // rad and m
  LoopSense by = LoopSense::surfaces;
};

// A key frame was found in a map whose poses are settled: an earlier session's, or what came before the filter began
// again.
struct PlaceMeasurement {
  std::int64_t key_frame = 0;
  int map = 0;                                 // which: each has a frame of its own
  Pose T_map_body;                             // in that one's frame
  Matrix6d covariance = Matrix6d::Identity();  // of T_map_body: [rotation (right), position (map's axes)], rad and m
};

}  // namespace lxd
