// SPDX-License-Identifier: Apache-2.0
#include "mapping/free_space.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mapping/cell_filter.hpp"
#include "mapping/lattice_walk.hpp"
#include "mapping/ray_layer.hpp"

namespace lxd {
namespace {

constexpr float kBehind = 1.0F;      // spacings behind a surface that a beam has to end to have gone through it
constexpr float kUponSigmas = 3.0F;  // a beam has ended on a surface within so many of its sigmas
constexpr float kUpon = 0.5F;        // and so many spacings
constexpr std::uint32_t kPassesMin = 2;
constexpr std::int32_t kSideVotesMin = 3;
constexpr float kFlat = 0.1F;              // cosine to the normal of a beam that tells no side
constexpr std::uint32_t kEndsPerPass = 4;  // at least so many beams have to end on what one more goes through

// Of what beams meet at random places, so much is left empty at an end by so many, as a share and on average.
float empty_by_chance(float ends) { return 1 / (1 + ends); }

bool is_passed(const QuadBeams& beams) {
  return beams.passes >= kPassesMin && kEndsPerPass * beams.passes > beams.ends;
}

// Beams that came from the side of +axis less those that came from the other.
std::int32_t side_vote(std::uint32_t bits) { return std::bit_cast<std::int32_t>(bits); }

void increment(QuadBeams& beams, std::uint8_t QuadBeams::*count) {
  if (beams.*count == UINT8_MAX) {
    beams.passes /= 2;
    beams.ends /= 2;
  }
  ++(beams.*count);
}

class BeamCount {
 public:
  BeamCount(const SubMesh& sub_mesh, float cell_size_m, std::span<const std::uint32_t> quads,
            std::span<std::uint32_t> counts, std::span<std::uint32_t> scratch)
      : sub_mesh_(sub_mesh),
        cell_size_m_(cell_size_m),
        spacing_m_(cell_size_m / kQuadsPerEdge),
        quads_(quads),
        counts_(counts),
        exported_(scratch) {
    for (std::size_t i = 0; i < quads_.size(); ++i)
      if (quads_[i] != 0)
        exported_.insert(sub_mesh_.cells()[sub_mesh_.layer(static_cast<std::uint32_t>(i)).cell].index);
  }

  void add(const Beam& beam) {
    const Eigen::Vector3d way = beam.to_m - beam.from_m;
    const double range_m = way.norm();
    const Ray ray{beam.from_m, way / range_m, range_m};
    if (!is_castable(ray)) return;
    ends_on(beam.to_m, ray.direction.cast<float>());
    passes(ray);
  }

 private:
  // Calls visit(layer's index, layer) for those that are exported.
  template <typename Visit>
  void for_each_layer(const CellIndex& index, Visit visit) {
    const std::uint32_t found = sub_mesh_.find(index);
    if (found == kNone) return;
    const Cell& cell = sub_mesh_.cells()[found];
    for (std::uint32_t k = 0; k < cell.layer_count; ++k)
      if (cell.layers[k] < quads_.size() && quads_[cell.layers[k]] != 0)
        visit(cell.layers[k], sub_mesh_.layer(cell.layers[k]));
  }

  void count(std::uint32_t layer, int quad, std::uint8_t QuadBeams::*what, std::uint16_t met) {
    std::uint32_t& bits = counts_[layer * kBeamCounts + static_cast<std::uint32_t>(quad)];
    QuadBeams beams = QuadBeams::of(bits);
    increment(beams, what);
    beams.met |= met;
    bits = beams.bits();
  }

  std::uint32_t& side_votes(std::uint32_t layer) { return counts_[layer * kBeamCounts + kLayerQuads]; }

  // In its own cell, and where a neighbour's surface sticks out into it.
  void ends_on(const Eigen::Vector3d& p_m, const Eigen::Vector3f& direction) {
    const CellIndex index = cell_of(p_m, 1.0 / cell_size_m_);
    const Eigen::Vector3f p = (p_m - index.cast<double>() * cell_size_m_).cast<float>();
    for_each_layer(index, [&](std::uint32_t i, const Layer& layer) { end_on(i, layer, p, direction); });
    for (int axis = 0; axis < 3; ++axis) {
      const int step = p[axis] < kUpon * spacing_m_ ? -1 : p[axis] > cell_size_m_ - kUpon * spacing_m_ ? 1 : 0;
      if (step == 0) continue;
      const CellIndex next = index + step * CellIndex::Unit(axis);
      const Eigen::Vector3f p_next = p - static_cast<float>(step) * cell_size_m_ * Eigen::Vector3f::Unit(axis);
      for_each_layer(next, [&](std::uint32_t i, const Layer& layer) {
        if (layer.axis == axis) end_on(i, layer, p_next, direction);
      });
    }
  }

  void end_on(std::uint32_t i, const Layer& layer, const Eigen::Vector3f& p_cell_m, const Eigen::Vector3f& direction) {
    const float inverse_spacing = 1 / spacing_m_;
    const LayerDistance at = distance_to(layer, p_cell_m, inverse_spacing);
    if (std::abs(at.distance_m) > kUponSigmas * std::sqrt(at.variance_m2) + kUpon * spacing_m_) return;
    constexpr int kParts = QuadBeams::kParts;
    const auto part_at = [&](float along_m) {
      return std::clamp(static_cast<int>(along_m * inverse_spacing * kParts), 0, kQuadsPerEdge * kParts - 1);
    };
    const int u = part_at(p_cell_m[axis_u(layer.axis)]), v = part_at(p_cell_m[axis_v(layer.axis)]);
    const auto part = static_cast<std::uint16_t>(1 << (v % kParts * kParts + u % kParts));
    count(i, v / kParts * kQuadsPerEdge + u / kParts, &QuadBeams::ends, part);
    const float cosine = at.normal.dot(direction);
    std::uint32_t& votes = side_votes(i);
    if (std::abs(cosine) > kFlat) votes = cosine < 0 ? votes + 1 : votes - 1;
  }

  void passes(const Ray& ray) {
    LatticeWalk blocks(ray, cell_size_m_ * CellFilter::kBlockEdge, 0, ray.range_m);
    do {
      const std::uint64_t exported = exported_.cells_of(blocks.index());
      if (exported == 0) continue;
      LatticeWalk cells(ray, cell_size_m_, blocks.entry_m(), blocks.exit_m());
      do {
        // By rounding the walk may look into a cell of the next block, which does so itself.
        const bool counts = (exported & CellFilter::bit_of(cells.index())) != 0 &&
                            CellFilter::block_of(cells.index()) == blocks.index();
        if (counts) pass_cell(ray, cells.index(), cells.entry_m());
      } while (cells.advance());
    } while (blocks.advance());
  }

  void pass_cell(const Ray& ray, const CellIndex& index, double entry_m) {
    const Eigen::Vector3d entry = ray.at(entry_m) - index.cast<double>() * cell_size_m_;
    const CellRay in_cell{entry.cast<float>(), ray.direction.cast<float>(), cell_size_m_};
    const auto left_m = static_cast<float>(ray.range_m - entry_m);
    for_each_layer(index, [&](std::uint32_t i, const Layer& layer) {
      LayerCrossing crossing;
      if (!first_crossing(layer, in_cell, quads_[i], crossing)) return;
      const float behind_m = -(left_m - crossing.along_m) * crossing.normal.dot(in_cell.direction);
      if (behind_m > kBehind * spacing_m_) count(i, crossing.quad, &QuadBeams::passes, 0);
    });
  }

  const SubMesh& sub_mesh_;
  float cell_size_m_, spacing_m_;
  std::span<const std::uint32_t> quads_;
  std::span<std::uint32_t> counts_;
  CellFilter exported_;  // cells with layers that are
};

}  // namespace

std::array<float, 4> QuadBeams::overhang() const {
  constexpr unsigned kRow = (1U << kParts) - 1, kColumn = 0x1111;
  const float by_chance = empty_by_chance(ends);
  const auto empty = [&](auto line) {
    int lines = 0;
    while (lines < kParts && (met & line(lines)) == 0) ++lines;
    return std::max(0.0F, static_cast<float>(lines) / kParts - by_chance);
  };
  return {empty([](int k) { return kRow << (k * kParts); }), empty([](int k) { return kColumn << (kParts - 1 - k); }),
          empty([](int k) { return kRow << ((kParts - 1 - k) * kParts); }), empty([](int k) { return kColumn << k; })};
}

std::array<float, 4> overhang_of_notch(std::span<const std::uint32_t> layer_beams, std::uint32_t seen_quads) {
  constexpr float kEmpty = 0.5F;
  float ends = 0;
  for (std::size_t q = 0; q < kLayerQuads; ++q)
    if ((seen_quads >> q & 1U) != 0) ends += QuadBeams::of(layer_beams[q]).ends;
  const auto seen = static_cast<float>(std::max(1, std::popcount(seen_quads)));
  const float share = std::max(0.0F, kEmpty - empty_by_chance(ends / seen));
  return {share, share, share, share};
}

void judge_by_beams(const SubMesh& sub_mesh, BeamSource& source, float cell_size_m, const LayerVerdicts& verdicts,
                    std::span<std::uint32_t> scratch) noexcept {
  std::ranges::fill(verdicts.counts, 0);
  BeamCount count(sub_mesh, cell_size_m, verdicts.quads, verdicts.counts, scratch);
  for (auto beams = source.next(); !beams.empty(); beams = source.next())
    for (const Beam& beam : beams) count.add(beam);
  for (std::size_t layer = 0; layer < verdicts.quads.size(); ++layer) {
    const auto counts = verdicts.counts.subspan(layer * kBeamCounts, kBeamCounts);
    std::uint32_t gone = 0;
    for (std::size_t q = 0; q < kLayerQuads; ++q)
      gone |= static_cast<std::uint32_t>(is_passed(QuadBeams::of(counts[q]))) << q;
    verdicts.quads[layer] &= ~gone;
    const std::int32_t votes = side_vote(counts[kLayerQuads]);
    if (std::abs(votes) >= kSideVotesMin) verdicts.sides[layer] = votes > 0 ? std::int8_t{1} : std::int8_t{-1};
  }
}

}  // namespace lxd
