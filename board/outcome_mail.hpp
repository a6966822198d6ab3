// SPDX-License-Identifier: Apache-2.0
// From the real-time thread to the one that writes: each sweep's outcome with its points and what its image showed,
// copied into slots of fixed size, and the sub-mesh that has left the window, lent until it is stored.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "board/default/capacities.hpp"
#include "board/map_keeper.hpp"
#include "estimator/sweep_outcome.hpp"
#include "mapping/surface_map.hpp"
#include "rt/spsc_ring.hpp"

namespace lxd {

class OutcomeMail {
 public:
  static constexpr std::size_t kSlots = 32;  // 3 s of sweeps at 10 Hz that a disk may stand still

  OutcomeMail();

  // Real-time thread. False: all slots wait to be written; the outcome is not taken.
  bool post(const SweepOutcome& outcome, const FilterView& view) noexcept;
  // Real-time thread, after each sweep: lends the map's retired sub-mesh, and gives it back once it is stored.
  void exchange_retired(SurfaceMap& map) noexcept;

  // Writing thread. The oldest, valid until release(); null: none waits.
  struct Letter {
    SweepOutcome outcome;
    FilterView view;
  };
  [[nodiscard]] const Letter* front();
  void release();
  // Writing thread. The sub-mesh to store, null: none; then stored().
  [[nodiscard]] const SubMesh* lent() const { return stored_ ? nullptr : lent_.load(std::memory_order_acquire); }
  void stored() { stored_.store(true, std::memory_order_release); }

 private:
  struct Slot {
    Letter letter;
    std::vector<RegisteredPoint> points;
    std::array<SightedFeature, kFeaturesMax> features;
  };

  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_slots_, posted_slots_;  // of the rings
  SpscRing<std::uint32_t> free_, posted_;
  std::atomic<const SubMesh*> lent_{nullptr};
  std::atomic<bool> stored_{false};  // what is lent
};

}  // namespace lxd
