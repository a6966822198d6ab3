// SPDX-License-Identifier: Apache-2.0
#include "board/outcome_mail.hpp"

#include "board/default/capacities.hpp"

namespace lxd {

OutcomeMail::OutcomeMail() : free_slots_(kSlots), posted_slots_(kSlots), free_(free_slots_), posted_(posted_slots_) {
  slots_.reserve(kSlots);
  for (std::uint32_t i = 0; i < kSlots; ++i) {
    slots_.emplace_back(capacities::kRegistrationPointsMax);
    (void)free_.push(i);
  }
}

bool OutcomeMail::post(const SweepOutcome& outcome, const FilterView& view) noexcept {
  const auto index = free_.pop();
  if (!index) return false;
  slots_[*index].keep(outcome, view);
  return posted_.push(*index);
}

const KeptOutcome* OutcomeMail::front() {
  const std::uint32_t* const index = posted_.front();
  return index == nullptr ? nullptr : &slots_[*index];
}

void OutcomeMail::release() {
  if (const auto index = posted_.pop()) (void)free_.push(*index);
}

}  // namespace lxd
