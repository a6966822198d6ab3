// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/place_memory.hpp"

#include <utility>

namespace lxd {

std::uint32_t PlaceMemory::add_submesh(std::int64_t id, std::span<const Surfel> surfels) {
  Surfaces kept{id, {}};
  kept.surfels.reserve(surfels.size());
  for (const Surfel& s : surfels)
    if (PackedSurfel::fits(s)) kept.surfels.push_back(PackedSurfel::pack(s));
  surfels_ += kept.surfels.size();
  submeshes_.push_back(std::move(kept));
  while (surfels_ > config_.surfels_max && oldest_kept_ + 1 < submeshes_.size()) {
    std::vector<PackedSurfel>& given_up = submeshes_[oldest_kept_++].surfels;
    surfels_ -= given_up.size();
    given_up = {};
  }
  return static_cast<std::uint32_t>(submeshes_.size() - 1);
}

void PlaceMemory::add_place(const LoopPlace& place) {
  if (places_.size() >= config_.places_max) thin_out();
  index_.add(place.key, static_cast<std::uint32_t>(places_.size()));
  places_.push_back(place);
}

// Every second place goes.
void PlaceMemory::thin_out() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < places_.size(); i += 2) places_[kept++] = places_[i];
  forgotten_ += places_.size() - kept;
  places_.resize(kept);
  index_ = PlaceIndex();
  for (std::uint32_t i = 0; i < places_.size(); ++i) index_.add(places_[i].key, i);
}

std::optional<std::vector<Surfel>> PlaceMemory::surfaces(std::uint32_t submesh) const {
  const Surfaces& kept = submeshes_[submesh];
  if (submesh < oldest_kept_) {
    std::vector<MeshVertex> vertices;
    if (!source_ || !source_(kept.id, vertices)) return std::nullopt;
    return thin_surfels(vertices, thinning_);
  }
  std::vector<Surfel> out;
  out.reserve(kept.surfels.size());
  for (const PackedSurfel& s : kept.surfels) out.push_back(s.unpack());
  return out;
}

std::size_t PlaceMemory::bytes() const {
  return places_.capacity() * sizeof(LoopPlace) + surfels_ * sizeof(PackedSurfel);
}

}  // namespace lxd
