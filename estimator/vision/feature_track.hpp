// SPDX-License-Identifier: Apache-2.0
// One feature's life in the real-time thread: candidate, mature, rejected; lost is who is no more in the image.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "estimator/vision/depth_filter.hpp"
#include "estimator/vision/feature_window.hpp"

namespace lxd {

enum class FeatureStage : std::uint8_t {
  candidate,  // too young, or its distance not known well enough
  mature,     // takes part in the update
  rejected    // moves by itself, or what is seen there changes: ignored until it is lost
};

enum class DepthSource : std::uint8_t { none, surface, triangulation };

inline constexpr std::uint32_t kNoFrame = 0xFFFFFFFFu;

struct FeatureTrack {
  std::uint32_t id = 0;
  std::uint32_t images = 0;         // in which it was seen since it was taken up
  std::uint32_t anchor = kNoFrame;  // number of a window frame
  FeatureStage stage = FeatureStage::candidate;
  DepthSource source = DepthSource::none;
  bool no_surface = false;  // rays at it contradicted each other: an edge
  float suspicion = 0;      // cumulated excess of squared innovations
  AnchoredPoint point;      // the bearing counts once there is an anchor, the depth once there is a source
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();     // in the present image
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  // likewise
  // Bearings in window frames, by number modulo their count; the number tells whether one is of that frame.
  std::array<std::array<float, 3>, kWindowFrames> seen_bearing{};
  std::array<std::uint32_t, kWindowFrames> seen_in{};

  [[nodiscard]] bool was_seen_in(std::uint32_t frame) const { return seen_in[frame % kWindowFrames] == frame; }
  [[nodiscard]] Eigen::Vector3d bearing_in(std::uint32_t frame) const {
    const auto& b = seen_bearing[frame % kWindowFrames];
    return {b[0], b[1], b[2]};
  }
  void see(std::uint32_t frame) {
    seen_in[frame % kWindowFrames] = frame;
    const Eigen::Vector3f b = bearing.cast<float>();
    seen_bearing[frame % kWindowFrames] = {b.x(), b.y(), b.z()};
  }
};

}  // namespace lxd
