// SPDX-License-Identifier: Apache-2.0
// The way of a return, from the LiDAR to what it fell on.
#pragma once

#include <span>

#include <Eigen/Core>

namespace lxd {

struct Beam {
  Eigen::Vector3d from_m, to_m;  // world
};

// Many of them, some at a time.
class BeamSource {
 public:
  // None: that was all.
  virtual std::span<const Beam> next() = 0;

 protected:
  ~BeamSource() = default;
};

class NoBeams final : public BeamSource {
 public:
  std::span<const Beam> next() override { return {}; }
};

}  // namespace lxd
