// SPDX-License-Identifier: Apache-2.0
// What the keeper tells of itself in the report.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "board/map_keeper.hpp"
#include "board/real_time_meter.hpp"

namespace lxd {
namespace {

void count(Report::Counts& counts, std::initializer_list<std::pair<const char*, std::uint64_t>> causes) {
  for (const auto& [cause, times] : causes)
    if (times > 0) counts[cause] += times;
}

}  // namespace

void MapKeeper::count_rejected(const PoseGraph& graph) {
  const LoopCounts loops = graph.loop_counts();
  const PlaceCounts places = graph.place_counts();
  count(loops_rejected_, {{"not_finite", loops.not_finite},
                          {"unknown_key_frame", loops.unknown_key_frame + places.not_sound},
                          {"against_drift", loops.against_drift},
                          {"unseconded", loops.waiting + places.waiting}});
  const GnssCounts gnss = graph.gnss_counts();
  counts_.fixes_used += gnss.used;
  if (graph.noise()) counts_.noise = graph.noise();
  count(fixes_rejected_, {{"not_finite", gnss.not_finite},
                          {"unaligned", gnss.unaligned},
                          {"jumped", gnss.jumped},
                          {"outlying", gnss.outlying}});
}

// Of the path's piece that ends.
void MapKeeper::note_loops(const PoseGraph& graph) {
  const auto believed = graph.loops();
  for (const LoopMeasurement& loop : found_) {
    const bool accepted = std::ranges::any_of(believed, [&](const LoopMeasurement& other) {
      return other.from == loop.from && other.to == loop.to && other.by == loop.by;
    });
    loops_.push_back({graph.key_frame(static_cast<int>(loop.from)).stamp,
                      graph.key_frame(static_cast<int>(loop.to)).stamp, loop, accepted});
  }
  found_.clear();
}

void MapKeeper::write_map(Report& report) const {
  const int main = main_map();
  MapReport& map = report.map;
  map.pieces = pieces_.size();
  for (const Piece& piece : pieces_) {
    map.pieces_apart += piece.map != main && piece.key_frames > 0;
    map.places += piece.places;
    if (piece.map == kEarlierMap && !map.relocalised_t_s) map.relocalised_t_s = piece.found->seconds();
  }
  if (map.pieces_apart > 0)
    report.hints.push_back(
        fmt::format("the filter began again {} times, and {} of the pieces were never found in the others: they are in "
                    "map.db, each in a frame of its own, and not in the mesh, the cloud and the trajectory",
                    map.pieces - 1, map.pieces_apart));
  if (!earlier_) return;
  map.earlier = earlier_->file.string();
  map.localise = earlier_->localise;
  if (!map.relocalised_t_s)
    report.hints.push_back(fmt::format("never found in {}: this run has a frame of its own, and nothing was merged",
                                       earlier_->file.string()));
}

void MapKeeper::write_sight(Report& report) const {
  const SightCounters& sought = closer_->sight_counters();
  SightReport& sight = report.sight.emplace();
  sight.key_frames = sought.key_frames;
  sight.images_gone = sight_->counts().images_gone;
  sight.unlooked = unlooked_;
  sight.poor = sought.poor;
  sight.asked = sought.asked;
  sight.candidates = sought.candidates;
  constexpr std::array<const char*, kPnpVerdicts> kVerdicts{"accepted", "few_matches", "few_inliers", "uncertain"};
  for (std::size_t i = 0; i < kVerdicts.size(); ++i) sight.verified[kVerdicts[i]] = sought.verdicts[i];
  sight.accepted = counts_.loops_accepted_by_sight;
}

void MapKeeper::write(Report& report) const {
  report.back_end = counts_;
  report.loops = loops_;
  report.back_end.key_frame_ms = summarise(worker_->latency());
  const LoopCounters& sought = closer_->counters();
  report.back_end.loops_proposed = sought.proposed;
  constexpr std::array<const char*, kLoopVerdicts> kVerdicts{
      "", "little_seen", "little_overlap", "poor_fit", "moved_away", "ambiguous", "open"};
  for (std::size_t i = 1; i < kVerdicts.size(); ++i)
    count(report.rejected["loops"], {{kVerdicts[i], sought.verdicts[i]}});
  count(report.rejected["loops"], {{"surfaces_gone", sought.surfaces_gone}, {"unsought_sub_mesh", unsought_}});
  if (report.rejected["loops"].empty()) report.rejected.erase("loops");
  if (sight_) write_sight(report);
  write_map(report);
  for (const auto& [cause, times] : loops_rejected_) report.rejected["loops"][cause] += times;
  for (const auto& [cause, times] : fixes_rejected_) report.rejected["gnss"][cause] += times;
  if (!gnss_) return;
  for (const auto& [cause, times] : gnss_->rejected()) report.rejected["gnss"][cause] += times;
}

}  // namespace lxd
