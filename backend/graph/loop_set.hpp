// SPDX-License-Identifier: Apache-2.0
// Which of the proposed loops are true. A loop must agree with what odometry can have drifted, and it must belong to
// the largest set in which every loop agrees with every other. Looks alike happen; looks alike that agree with each
// other and with odometry hardly do. Work and memory for each loop are bounded, however many come.
#pragma once

#include <cstdint>
#include <vector>

#include "backend/graph/agreement.hpp"
#include "backend/graph/odometry_chain.hpp"
#include "backend/loop_measurement.hpp"

namespace lxd {

struct LoopCounts {
  std::uint64_t proposed = 0, accepted = 0;
  std::uint64_t accepted_by_sight = 0;  // of them
  std::uint64_t not_finite = 0, unknown_key_frame = 0;
  std::uint64_t against_drift = 0;  // farther off than odometry can be
  std::uint64_t waiting = 0;        // for others that agree; or outvoted by them
};

// What a closed loop is good for at best.
Matrix6d with_loop_floor(Matrix6d covariance, const GraphConfig& config);

class LoopSet {
 public:
  LoopSet(const GraphConfig& config, const OdometryChain& chain)
      : config_(config), chain_(chain), agreement_(static_cast<std::size_t>(config.loop_agreeing_min)) {}

  // True: the accepted loops are others than before.
  bool add(const LoopMeasurement& loop);

  // With the covariance that they have at least.
  [[nodiscard]] std::vector<LoopMeasurement> accepted() const;
  [[nodiscard]] LoopCounts counts() const;

 private:
  [[nodiscard]] bool sound(const LoopMeasurement& loop);
  [[nodiscard]] bool within_drift(const LoopMeasurement& loop) const;
  [[nodiscard]] bool agree(const LoopMeasurement& a, const LoopMeasurement& b) const;
  void retire_oldest();

  GraphConfig config_;
  const OdometryChain& chain_;
  Agreement agreement_;
  std::vector<LoopMeasurement> set_;      // whose agreement is known; of too many the oldest keep their verdict
  std::vector<LoopMeasurement> settled_;  // accepted, and no longer compared
  LoopCounts counts_;
};

}  // namespace lxd
