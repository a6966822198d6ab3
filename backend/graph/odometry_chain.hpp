// SPDX-License-Identifier: Apache-2.0
// The key frames in a row, as odometry has them: how one lies to another, and how far that can be off.
#pragma once

#include <vector>

#include "backend/graph/config.hpp"
#include "backend/graph/relative_motion.hpp"
#include "rt/key_frame.hpp"

namespace lxd {

class OdometryChain {
 public:
  explicit OdometryChain(const GraphConfig& config) : config_(config) {}

  // Key frames come in the order of their ids, from 0.
  void add(const KeyFrame& key_frame);

  [[nodiscard]] int size() const { return static_cast<int>(links_.size()); }
  [[nodiscard]] const KeyFrame& operator[](int i) const { return links_[static_cast<std::size_t>(i)].key_frame; }
  [[nodiscard]] const KeyFrame& back() const { return links_.back().key_frame; }
  // T_i-1_i. i > 0.
  [[nodiscard]] const RelativeMotion& step(int i) const { return links_[static_cast<std::size_t>(i)].step; }
  // T_i_j, in constant time; in either direction.
  [[nodiscard]] RelativeMotion motion(int i, int j) const;
  // Way driven from the first to this one.
  [[nodiscard]] double path_m(int i) const { return links_[static_cast<std::size_t>(i)].path_m; }

 private:
  struct Link {
    KeyFrame key_frame;
    RelativeMotion step, from_first;
    double path_m;
  };
  [[nodiscard]] Matrix6d drift(const KeyFrame& key_frame) const;

  GraphConfig config_;
  std::vector<Link> links_;
};

}  // namespace lxd
