// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/context_match.hpp"

#include <algorithm>
#include <numbers>

namespace lxd {

double ContextMatch::yaw_rad() const {
  const double turn = 2 * std::numbers::pi * shift / kContextSectors;
  return turn > std::numbers::pi ? turn - 2 * std::numbers::pi : turn;
}

void ContextMatcher::unpack(const ScanContext& context, Unpacked& out) {
  out.structure_bins = 0;
  for (int ring = 0; ring < kContextRings; ++ring) {
    for (int sector = 0; sector < kContextSectors; ++sector) {
      const std::size_t bin = ScanContext::bin(ring, sector);
      const bool seen = context.visibility[bin] != Visibility::unknown;
      const bool structure = context.visibility[bin] == Visibility::occupied;
      out.seen(sector, ring) = seen ? 1.0F : 0.0F;
      out.height.value(sector, ring) = seen ? static_cast<float>(context.height[bin]) : 0.0F;
      out.density.value(sector, ring) = seen ? static_cast<float>(context.density[bin]) : 0.0F;
      out.structure.value(sector, ring) = structure ? 1.0F : 0.0F;
      out.structure_bins += structure ? 1.0F : 0.0F;
    }
  }
  out.seen.bottomRows<kContextSectors>() = out.seen.topRows<kContextSectors>();
  for (Channel* channel : {&out.height, &out.density, &out.structure}) {
    channel->value.bottomRows<kContextSectors>() = channel->value.topRows<kContextSectors>();
    channel->square = channel->value.square();
  }
}

ContextMatcher::Products ContextMatcher::multiply(const Unpacked& q, const Unpacked& c, const Channel& in_q,
                                                  const Channel& in_c, int shift) {
  Products sum{Sectors::Zero(), Sectors::Zero(), Sectors::Zero()};
  for (int ring = 0; ring < kContextRings; ++ring) {
    const auto turned = [&](const Plane& plane) { return plane.col(ring).segment<kContextSectors>(shift); };
    const auto still = [&](const Plane& plane) { return plane.col(ring).head<kContextSectors>(); };
    sum.cross += still(in_q.value) * turned(in_c.value);
    sum.query += still(in_q.square) * turned(c.seen);
    sum.candidate += still(q.seen) * turned(in_c.square);
  }
  return sum;
}

// One minus the mean likeness of the sectors in which both places show something, and what each has that the other has
// not seen; 1 when too little is common. A sector's likeness is the cosine of its column, as in Scan Context, a channel
// each, over the bins that both have seen.
double ContextMatcher::distance_at(int shift) const {
  const Products structure = multiply(query_, candidate_, query_.structure, candidate_.structure, shift);
  const double common = static_cast<double>(
      std::min(structure.query.sum() / query_.structure_bins, structure.candidate.sum() / candidate_.structure_bins));
  if (common < config_.common_min) return 1;
  const Products height = multiply(query_, candidate_, query_.height, candidate_.height, shift);
  const Products density = multiply(query_, candidate_, query_.density, candidate_.density, shift);
  Sectors likeness = Sectors::Zero(), weight = Sectors::Zero();
  const auto add = [&](const Products& p, float channel_weight) {
    const Sectors norms = (p.query * p.candidate).sqrt();
    const auto shown = norms > 0.0F;
    likeness += shown.select(channel_weight * p.cross / norms.max(1.0e-6F), 0.0F);
    weight += shown.select(Sectors::Constant(channel_weight), 0.0F);
  };
  add(height, 1);
  add(structure, 1);
  add(density, static_cast<float>(config_.density_weight));
  // A sector of ground alone has no height to speak of and says nothing.
  const auto shown = height.query * height.candidate > 0.0F;
  const auto sectors = static_cast<float>(shown.count());
  if (sectors == 0.0F) return 1;
  const double unlike = 1.0 - static_cast<double>(shown.select(likeness / weight.max(1.0e-6F), 0.0F).sum() / sectors);
  return std::min(1.0, unlike + config_.unseen_weight * (1 - common));
}

ContextMatch ContextMatcher::match(const ScanContext& candidate) {
  unpack(candidate, candidate_);
  ContextMatch best;
  if (query_.structure_bins == 0.0F || candidate_.structure_bins == 0.0F) return best;
  for (int shift = 0; shift < kContextSectors; ++shift) {
    const double distance = distance_at(shift);
    if (distance < best.distance) best = {distance, shift};
  }
  return best;
}

}  // namespace lxd
