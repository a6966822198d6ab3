// SPDX-License-Identifier: Apache-2.0
// From the real-time thread to the one that writes: each sweep's outcome with its points and what its image showed,
// copied into slots of fixed size.
#pragma once

#include <cstdint>
#include <vector>

#include "board/kept_outcome.hpp"
#include "rt/spsc_ring.hpp"

namespace lxd {

class OutcomeMail {
 public:
  static constexpr std::size_t kSlots = 32;  // 3 s of sweeps at 10 Hz that a disk may stand still

  OutcomeMail();

  // Real-time thread. False: all slots wait to be written; the outcome is not taken.
  bool post(const SweepOutcome& outcome, const FilterView& view) noexcept;

  // Writing thread. The oldest, valid until release(); null: none waits.
  [[nodiscard]] const KeptOutcome* front();
  void release();

 private:
  std::vector<KeptOutcome> slots_;
  std::vector<std::uint32_t> free_slots_, posted_slots_;  // of the rings
  SpscRing<std::uint32_t> free_, posted_;
};

}  // namespace lxd
