// SPDX-License-Identifier: Apache-2.0
#include "backend/sight/sight_memory.hpp"

#include <algorithm>
#include <utility>

namespace lxd {

void SightMemory::add(SightedPlace place) {
  if (place.frame.features.size() > config_.features_max) place.frame.features.resize(config_.features_max);
  place.frame.features.shrink_to_fit();
  places_.push_back(std::move(place));
  if (places_.size() > config_.frames_max) thin_out();
}

void SightMemory::release(const std::function<bool(const SightedPlace&)>& may_be_found) {
  for (; released_ < places_.size() && may_be_found(places_[released_]); ++released_)
    index_.add(static_cast<std::uint32_t>(released_), places_[released_].frame.features);
}

void SightMemory::begin_again() {
  for (SightedPlace& place : places_) place.at.earlier = true;
}

// The index is made anew: that is once in so many key frames.
void SightMemory::thin_out() {
  const std::size_t before = places_.size(), older = before / 2;
  std::size_t kept = 0, released = 0;
  for (std::size_t i = 0; i < before; ++i) {
    if (i < older && i % 2 == 1) continue;
    released += i < released_ ? 1 : 0;
    if (kept != i) places_[kept] = std::move(places_[i]);
    ++kept;
  }
  places_.erase(places_.begin() + static_cast<std::ptrdiff_t>(kept), places_.end());
  forgotten_ += before - kept;
  index_.clear();
  for (released_ = 0; released_ < released; ++released_)
    index_.add(static_cast<std::uint32_t>(released_), places_[released_].frame.features);
}

std::size_t SightMemory::bytes() const {
  std::size_t out = index_.bytes();
  for (const SightedPlace& place : places_)
    out += sizeof(SightedPlace) + place.frame.features.capacity() * sizeof(VisualFeature);
  return out;
}

}  // namespace lxd
