// SPDX-License-Identifier: Apache-2.0
// The sub-mesh that has left the window, lent by the thread that filters to the one that writes until it is stored.
#pragma once

#include <atomic>
#include <cstdint>

#include "mapping/surface_map.hpp"

namespace lxd {

class SubMeshLoan {
 public:
  // Filtering thread, after each sweep: takes back what is stored, lends what has retired. Is something newly lent?
  bool exchange(SurfaceMap& map) noexcept {
    if (state_.load(std::memory_order_acquire) == State::stored) {
      map.release_retired();
      state_.store(State::none, std::memory_order_relaxed);
    }
    if (map.retired() == nullptr || state_.load(std::memory_order_relaxed) != State::none) return false;
    sub_mesh_ = map.retired();
    state_.store(State::lent, std::memory_order_release);
    return true;
  }

  // Writing thread. The one to store, null: none; then stored().
  [[nodiscard]] const SubMesh* lent() const {
    return state_.load(std::memory_order_acquire) == State::lent ? sub_mesh_ : nullptr;
  }
  void stored() { state_.store(State::stored, std::memory_order_release); }

 private:
  enum class State : std::uint8_t { none, lent, stored };
  std::atomic<State> state_{State::none};
  const SubMesh* sub_mesh_ = nullptr;  // the filter's while none, then the writing thread's
};

}  // namespace lxd
