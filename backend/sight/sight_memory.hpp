// SPDX-License-Identifier: Apache-2.0
// The visual key frames that are remembered, and the index of those that may be found again. Bounded: when there are
// too many, every second one of the older half goes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "backend/pnp/visual_key_frame.hpp"
#include "backend/sight/descriptor_index.hpp"
#include "rt/pose.hpp"

namespace lxd {

// Where a key frame was taken, as the filter had it.
struct SightPlace {
  Pose T_world_body;
  double path_m = 0;         // driven until then
  std::int64_t submesh = 0;  // that was being built; counts up
  bool earlier = false;      // of a path whose world is another one than this path's
};

struct SightedPlace {
  VisualKeyFrame frame;
  SightPlace at;
  [[nodiscard]] Pose T_world_camera() const { return at.T_world_body * frame.T_body_camera; }
};

struct SightMemoryConfig {
  std::size_t frames_max = 768;
  std::size_t features_max = 128;  // of each; 56 B, and 64 B in the index
};

class SightMemory {
 public:
  explicit SightMemory(const SightMemoryConfig& config)
      : config_(config), index_(config.frames_max * config.features_max) {}

  // Of a key frame with more features the first ones are kept.
  void add(SightedPlace place);
  // Those up to the first that may not be found yet can be found from now on.
  void release(const std::function<bool(const SightedPlace&)>& may_be_found);
  // What follows is a path in a world of its own.
  void begin_again();

  [[nodiscard]] std::span<const SightedPlace> places() const { return places_; }  // in order of time
  // Of places(), from the first.
  [[nodiscard]] std::size_t released() const { return released_; }
  // Of the released ones, in their order.
  [[nodiscard]] std::vector<float> votes(const VisualKeyFrame& frame) const {
    return index_.votes(frame.features, released_);
  }
  [[nodiscard]] std::uint64_t forgotten() const { return forgotten_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  void thin_out();

  SightMemoryConfig config_;
  std::vector<SightedPlace> places_;
  std::size_t released_ = 0;
  DescriptorIndex index_;
  std::uint64_t forgotten_ = 0;
};

}  // namespace lxd
