// SPDX-License-Identifier: Apache-2.0
#include "board/outcome_mail.hpp"

#include <algorithm>

namespace lxd {

OutcomeMail::OutcomeMail()
    : slots_(kSlots), free_slots_(kSlots), posted_slots_(kSlots), free_(free_slots_), posted_(posted_slots_) {
  for (std::uint32_t i = 0; i < kSlots; ++i) {
    slots_[i].points.resize(capacities::kRegistrationPointsMax);
    (void)free_.push(i);
  }
}

bool OutcomeMail::post(const SweepOutcome& outcome, const FilterView& view) noexcept {
  const auto index = free_.pop();
  if (!index) return false;
  Slot& slot = slots_[*index];
  slot.letter = {outcome, view};
  const std::size_t count = std::min(outcome.registered.size(), slot.points.size());
  std::copy_n(outcome.registered.begin(), count, slot.points.begin());
  slot.letter.outcome.registered = std::span(slot.points).first(count);
  const std::size_t features = std::min(view.sighted.features.size(), slot.features.size());
  std::copy_n(view.sighted.features.begin(), features, slot.features.begin());
  slot.letter.view.sighted.features = std::span(slot.features).first(features);
  return posted_.push(*index);
}

void OutcomeMail::exchange_retired(SurfaceMap& map) noexcept {
  if (lent_.load(std::memory_order_relaxed) == nullptr) {
    stored_.store(false, std::memory_order_relaxed);
    lent_.store(map.retired(), std::memory_order_release);
  } else if (stored_.load(std::memory_order_acquire)) {
    map.release_retired();
    lent_.store(nullptr, std::memory_order_release);
  }
}

const OutcomeMail::Letter* OutcomeMail::front() {
  const std::uint32_t* const index = posted_.front();
  return index == nullptr ? nullptr : &slots_[*index].letter;
}

void OutcomeMail::release() {
  if (const auto index = posted_.pop()) (void)free_.push(*index);
}

}  // namespace lxd
