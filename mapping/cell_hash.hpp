// SPDX-License-Identifier: Apache-2.0
// Spatial hash of a sub-mesh: cell key -> index, open addressing, linear probing, storage lent once. clear() is
// constant time, because a slot counts only when it carries the current epoch. Real-time thread only.
#pragma once

#include <cassert>
#include <span>

#include "mapping/lattice.hpp"

namespace lxd {

class CellHash {
 public:
  struct Slot {
    CellKey key = 0;
    std::uint32_t value = 0;
    std::uint32_t epoch = 0;
  };

  CellHash() = default;
  // slots.size(): a power of two, at least twice the number of cells that will be inserted.
  explicit CellHash(std::span<Slot> slots) : slots_(slots), mask_(slots.size() - 1) {
    assert((slots.size() & mask_) == 0);
  }

  void clear() { ++epoch_; }

  [[nodiscard]] std::uint32_t find(CellKey key) const {
    for (std::size_t i = home_of(key);; i = (i + 1) & mask_) {
      const Slot& slot = slots_[i];
      if (slot.epoch != epoch_) return kNone;
      if (slot.key == key) return slot.value;
    }
  }

  // Precondition: find(key) == kNone and less than half of the slots are in use.
  void insert(CellKey key, std::uint32_t value) {
    std::size_t i = home_of(key);
    while (slots_[i].epoch == epoch_) i = (i + 1) & mask_;
    slots_[i] = {key, value, epoch_};
  }

 private:
  [[nodiscard]] std::size_t home_of(CellKey key) const { return static_cast<std::size_t>(scatter(key)) & mask_; }

  std::span<Slot> slots_;
  std::size_t mask_ = 0;
  std::uint32_t epoch_ = 1;
};

}  // namespace lxd
