// SPDX-License-Identifier: Apache-2.0
// Pulses on their way to a sensor's clock model. They come by another way than the sensor's stamps, and later; so each
// is held back until a stamp was received that much after it. What the model hears then does not depend on which way
// was quicker, and a replay hears the same as the live rig did.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "rt/time.hpp"

namespace lxd {

class HeldPulses {
 public:
  static constexpr Duration kHeld = Duration::from_ns(250'000'000);  // a source is asked ten times a second

  // recorded: all that will ever come, in order. Allocates here alone.
  explicit HeldPulses(std::vector<RigTime> recorded = {}) : edges_(std::move(recorded)) {
    edges_.reserve(edges_.size() + kRoom);
  }

  // One more, of a live rig. While the sensor is silent the oldest are forgotten.
  void add(RigTime edge) {
    if (next_ == edges_.size() || edges_.size() == edges_.capacity()) {
      edges_.clear();
      next_ = 0;
    }
    edges_.push_back(edge);
  }

  // The next that the model is to hear before a stamp that was received then; ask until there is none.
  std::optional<RigTime> due(RigTime received) {
    if (next_ == edges_.size() || edges_[next_] + kHeld > received) return std::nullopt;
    return edges_[next_++];
  }

 private:
  static constexpr std::size_t kRoom = 64;

  std::vector<RigTime> edges_;
  std::size_t next_ = 0;
};

}  // namespace lxd
