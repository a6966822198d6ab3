// SPDX-License-Identifier: Apache-2.0
#include "backend/sight/sight_finder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lxd {

std::optional<LoopMeasurement> SightFinder::look(VisualKeyFrame frame, const SightPlace& at) {
  ++counters_.key_frames;
  memory_.release([&](const SightedPlace& place) {
    return place.at.earlier || place.at.submesh + config_.submesh_gap <= at.submesh;
  });
  if (frame.features.size() < config_.features_min) {
    ++counters_.poor;
    return std::nullopt;
  }
  SightedPlace query{std::move(frame), at};
  const bool due = !closed_at_m_ || at.path_m - *closed_at_m_ >= config_.loop_spacing_m;
  auto loop = due ? close(query) : std::nullopt;
  if (loop) closed_at_m_ = at.path_m;
  memory_.add(std::move(query));
  counters_.forgotten = memory_.forgotten();
  return loop;
}

void SightFinder::begin_again() {
  memory_.begin_again();
  closed_at_m_.reset();
}

// The first candidate that holds.
std::optional<LoopMeasurement> SightFinder::close(const SightedPlace& query) {
  ++counters_.asked;
  for (const SightedPlace* const candidate : candidates_of(query)) {
    ++counters_.candidates;
    const auto matches = match_features(candidate->frame.features, query.frame.features, config_.pnp.match);
    const PnpResult found = solve_pnp(candidate->frame, query.frame, matches, config_.pnp);
    ++counters_.verdicts[static_cast<std::size_t>(found.verdict)];
    if (found.verdict == PnpVerdict::accepted) return loop_of_cameras(candidate->frame, query.frame, found);
  }
  return std::nullopt;
}

std::vector<const SightedPlace*> SightFinder::candidates_of(const SightedPlace& query) const {
  std::vector<const SightedPlace*> out;
  if (const SightedPlace* const near = nearby(query)) out.push_back(near);
  add_alike(query, out);
  return out;
}

// The nearest place by the poses, which are right when the drift is small, of those that look the same way.
const SightedPlace* SightFinder::nearby(const SightedPlace& query) const {
  const SightedPlace* best = nullptr;
  double best_m = config_.nearby_m;
  const Pose T = query.T_world_camera();
  for (const SightedPlace& place : memory_.places().first(memory_.released())) {
    if (place.at.earlier) continue;
    const Pose there = place.T_world_camera();
    const double apart_m = (there.p - T.p).norm();
    if (apart_m >= best_m || there.R.col(2).dot(T.R.col(2)) < config_.heading_cos) continue;
    best_m = apart_m;
    best = &place;
  }
  return best;
}

// Those with the most votes, each of another stretch of way.
void SightFinder::add_alike(const SightedPlace& query, std::vector<const SightedPlace*>& out) const {
  std::vector<float> votes = memory_.votes(query.frame);
  for (std::size_t found = 0; found < config_.by_looks;) {
    const auto most = std::ranges::max_element(votes);
    if (most == votes.end() || *most < config_.votes_min) return;
    *most = 0;
    const SightedPlace& place = memory_.places()[static_cast<std::size_t>(most - votes.begin())];
    const bool other = std::ranges::none_of(out, [&](const SightedPlace* taken) {
      return taken->at.earlier == place.at.earlier && std::abs(taken->at.path_m - place.at.path_m) < config_.apart_m;
    });
    if (!other || !plausible(query, place)) continue;
    out.push_back(&place);
    ++found;
  }
}

bool SightFinder::plausible(const SightedPlace& query, const SightedPlace& candidate) const {
  if (candidate.at.earlier) return true;
  const double reach_m = config_.drift_floor_m + config_.drift_share * std::abs(query.at.path_m - candidate.at.path_m);
  return (query.at.T_world_body.p - candidate.at.T_world_body.p).norm() < reach_m;
}

}  // namespace lxd
