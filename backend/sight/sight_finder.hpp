// SPDX-License-Identifier: Apache-2.0
// Finds where the path meets itself by what a camera sees: visual key frames in, verified relative poses out. Low
// priority, one thread; bounded memory, bounded work a key frame. The same calls give the same loops.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "backend/pnp/bidirectional_pnp.hpp"
#include "backend/sight/sight_memory.hpp"

namespace lxd {

struct SightFinderConfig {
  SightMemoryConfig memory;
  PnpConfig pnp;
  std::int64_t submesh_gap = 3;  // sub-meshes that the filter still registers against: no loop to close
  std::size_t features_min = 20;
  double loop_spacing_m = 5;  // way after a found loop before the next is sought
  double drift_share = 0.05;  // of the way between two key frames, that the pose may be wrong by
  double drift_floor_m = 5;   // besides
  double nearby_m = 6;        // a place this near by the poses is a candidate whatever it looks like,
  double heading_cos = 0.8;   // if it looks the same way
  std::size_t by_looks = 2;   // places with the most votes that are verified
  double apart_m = 5;         // of way between two of them
  float votes_min = 2;
};

inline constexpr std::size_t kPnpVerdicts = static_cast<std::size_t>(PnpVerdict::uncertain) + 1;

struct SightCounters {
  std::uint64_t key_frames = 0;  // with an image
  std::uint64_t poor = 0;        // with too few features: they neither ask nor are remembered
  std::uint64_t asked = 0;       // others are too near to a loop that was found
  std::uint64_t forgotten = 0;
  std::uint64_t candidates = 0;                        // that were verified
  std::array<std::uint64_t, kPnpVerdicts> verdicts{};  // of them, by PnpVerdict
};

class SightFinder {
 public:
  explicit SightFinder(const SightFinderConfig& config) : config_(config), memory_(config.memory) {}

  // The next key frame, in order of time, and the loop that it closes with an earlier one; ids are theirs.
  std::optional<LoopMeasurement> look(VisualKeyFrame frame, const SightPlace& at);
  // What follows is a path in a world of its own: places so far are found by their looks alone.
  void begin_again();

  [[nodiscard]] const SightCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t bytes() const { return memory_.bytes(); }

 private:
  [[nodiscard]] std::optional<LoopMeasurement> close(const SightedPlace& query);
  [[nodiscard]] std::vector<const SightedPlace*> candidates_of(const SightedPlace& query) const;
  [[nodiscard]] const SightedPlace* nearby(const SightedPlace& query) const;
  void add_alike(const SightedPlace& query, std::vector<const SightedPlace*>& out) const;
  [[nodiscard]] bool plausible(const SightedPlace& query, const SightedPlace& candidate) const;

  SightFinderConfig config_;
  SightMemory memory_;
  std::optional<double> closed_at_m_;  // way at which a loop was found last
  SightCounters counters_;
};

}  // namespace lxd
