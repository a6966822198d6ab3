// SPDX-License-Identifier: Apache-2.0
// Which of the proposed loops are true. A loop must agree with what odometry can have drifted, and it must belong to
// the largest set in which every loop agrees with every other (pairwise consistency maximisation: Mangelson, Dominic,
// Eustice, Vasudevan, ICRA 2018). Looks alike happen; looks alike that agree with each other and with odometry hardly
// do. Work and memory for each loop are bounded, however many come.
#pragma once

#include <bitset>
#include <cstdint>
#include <vector>

#include "backend/graph/odometry_chain.hpp"
#include "backend/loop_measurement.hpp"

namespace lxd {

struct LoopCounts {
  std::uint64_t proposed = 0, accepted = 0;
  std::uint64_t not_finite = 0, unknown_key_frame = 0;
  std::uint64_t against_drift = 0;  // farther off than odometry can be
  std::uint64_t waiting = 0;        // for others that agree; or outvoted by them
};

class LoopSet {
 public:
  LoopSet(const GraphConfig& config, const OdometryChain& chain) : config_(config), chain_(chain) {}

  // True: the accepted loops are others than before.
  bool add(const LoopMeasurement& loop);

  // With the covariance that they have at least.
  [[nodiscard]] std::vector<LoopMeasurement> accepted() const;
  [[nodiscard]] LoopCounts counts() const;

  static constexpr std::size_t kSetMax = 256;  // loops that are compared with each other; older ones keep their verdict

 private:
  using Links = std::bitset<kSetMax>;
  struct Candidate {
    LoopMeasurement loop;
    Links agrees;
    bool accepted = false;
  };

  [[nodiscard]] bool sound(const LoopMeasurement& loop);
  [[nodiscard]] bool within_drift(const LoopMeasurement& loop) const;
  [[nodiscard]] bool agree(const LoopMeasurement& a, const LoopMeasurement& b) const;
  void retire_oldest();
  [[nodiscard]] Links clique_with(std::size_t seed) const;
  [[nodiscard]] Links largest_clique() const;

  GraphConfig config_;
  const OdometryChain& chain_;
  std::vector<Candidate> set_;
  std::vector<LoopMeasurement> settled_;  // accepted, and no longer compared
  LoopCounts counts_;
};

}  // namespace lxd
