// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/loop_finder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lxd {
namespace {

// From the level frames of the two key frames to their bodies.
LoopMeasurement between_bodies(const LoopPlace& candidate, const LoopPlace& query, const Verification& found) {
  const Eigen::Matrix3d &Rc = candidate.T_submesh_body.R, &Rq = query.T_submesh_body.R;
  LoopMeasurement out;
  out.from = candidate.id;
  out.to = query.id;
  out.T_from_to.R = Rc.transpose() * found.T_candidate_query.R * Rq;
  out.T_from_to.p = Rc.transpose() * found.T_candidate_query.p;
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = Rq.transpose();
  turn.bottomRightCorner<3, 3>() = Rc.transpose();
  out.covariance = turn * found.covariance * turn.transpose();
  return out;
}

}  // namespace

LoopFinder::LoopFinder(const LoopFinderConfig& config)
    : config_(config), memory_(config.memory, config.thinning), matcher_(config.match) {}

void LoopFinder::add(const LoopSubmesh& submesh, std::span<const LoopKeyFrame> key_frames) {
  remember(submesh, key_frames, std::nullopt);
}

void LoopFinder::add_earlier(const LoopSubmesh& submesh, std::span<const LoopKeyFrame> key_frames, int map) {
  last_place_m_.reset();
  remember(submesh, key_frames, map);
  last_place_m_.reset();
}

void LoopFinder::begin_again(const std::function<Earlier(std::int64_t id)>& earlier) {
  for (LoopPlace& place : memory_.places()) {
    if (place.earlier) continue;
    const Earlier now = earlier(place.id);
    place.earlier = now.map;
    place.p_world_m = now.p_map_m;
    place.pose_known = true;
  }
  located_.clear();
  waiting_.clear();
  closed_at_m_.clear();
  last_place_m_.reset();
}

void LoopFinder::remember(const LoopSubmesh& submesh, std::span<const LoopKeyFrame> key_frames,
                          std::optional<int> earlier) {
  const std::vector<Surfel> surfels = thin_surfels(submesh.vertices, config_.thinning);
  const std::uint32_t ordinal = memory_.add_submesh(submesh.id, surfels);
  const Pose T_submesh_world = submesh.T_world_submesh.inverse();
  for (const LoopKeyFrame& frame : key_frames) {
    if (last_place_m_ && frame.path_m < *last_place_m_ + config_.place_spacing_m) continue;
    last_place_m_ = frame.path_m;
    LoopPlace place;
    place.id = frame.id;
    place.submesh = ordinal;
    place.earlier = earlier;
    place.pose_known = frame.pose_known;
    place.T_submesh_body = T_submesh_world * frame.T_world_body;
    place.p_world_m = frame.T_world_body.p;
    place.path_m = frame.path_m;
    place.context = make_scan_context(surfels, place.T_submesh_body.p, config_.context);
    place.key = ring_key(place.context);
    memory_.add_place(place);
    ++counters_.places;
    if (!earlier) wait(place);
  }
  counters_.forgotten = memory_.forgotten();
}

void LoopFinder::wait(const LoopPlace& place) {
  waiting_.push_back(place);
  if (waiting_.size() <= config_.waiting_max) return;
  waiting_.pop_front();
  ++counters_.waiting_dropped;
}

bool LoopFinder::may_close(const LoopPlace& query, const LoopPlace& candidate) const {
  return candidate.earlier || candidate.submesh + config_.submesh_gap <= query.submesh;
}

// Where a place is by what is known; nothing: lost, or of a map that nobody knows the place of.
std::optional<Eigen::Vector3d> LoopFinder::in_world(const LoopPlace& place) const {
  if (!place.pose_known) return std::nullopt;
  if (!place.earlier) return place.p_world_m;
  const auto map = located_.find(*place.earlier);
  if (map == located_.end()) return std::nullopt;
  return map->second.T_world_map * place.p_world_m;
}

bool LoopFinder::plausible(const LoopPlace& query, const LoopPlace& candidate) const {
  const auto here = in_world(query), there = in_world(candidate);
  if (!here || !there) return true;
  const double since_m = candidate.earlier ? located_.at(*candidate.earlier).path_m : candidate.path_m;
  const double reach_m = config_.drift_floor_m + config_.drift_share * std::abs(query.path_m - since_m);
  return (*here - *there).norm() < reach_m;
}

// The nearest place by the poses, which are right when the drift is small: buildings' rooms look alike.
void LoopFinder::add_nearby(const LoopPlace& query, std::vector<Candidate>& out) const {
  const LoopPlace* best = nullptr;
  double best_m = config_.nearby_m;
  const auto here = in_world(query);
  if (!here) return;
  for (const LoopPlace& place : memory_.places()) {
    const auto there = may_close(query, place) ? in_world(place) : std::nullopt;
    if (!there) continue;
    const double apart_m = (*there - *here).norm();
    if (apart_m >= best_m) continue;
    best_m = apart_m;
    best = &place;
  }
  if (best != nullptr) out.push_back({best, 0.0});
}

void LoopFinder::add_alike(const LoopPlace& query, std::vector<Candidate>& out) {
  NearestQuery asked;
  asked.key = query.key;
  asked.count = config_.look_ups;
  asked.allowed = [&](std::uint32_t i) {
    const LoopPlace& place = memory_.places()[i];
    if (!may_close(query, place)) return false;
    const bool ok = plausible(query, place);
    counters_.implausible += ok ? 0 : 1;
    return ok;
  };
  matcher_.set_query(query.context);
  std::vector<std::pair<double, Candidate>> alike;
  for (const NearPlace& near : memory_.index().nearest(asked)) {
    const LoopPlace& place = memory_.places()[near.place];
    const ContextMatch match = matcher_.match(place.context);
    if (match.distance < config_.context_distance_max) alike.push_back({match.distance, {&place, match.yaw_rad()}});
  }
  std::stable_sort(alike.begin(), alike.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < std::min(config_.by_looks, alike.size()); ++i) out.push_back(alike[i].second);
}

std::vector<LoopFinder::Candidate> LoopFinder::candidates_of(const LoopPlace& query) {
  std::vector<Candidate> out;
  add_nearby(query, out);
  add_alike(query, out);
  return out;
}

std::optional<Surroundings> LoopFinder::surroundings(const LoopPlace& place) const {
  const auto surfels = memory_.surfaces(place.submesh);
  if (!surfels) return std::nullopt;
  return surroundings_of(*surfels, place.T_submesh_body.p, place.context, config_.verification.radius_m);
}

std::optional<LoopMeasurement> LoopFinder::verify(const LoopPlace& query, const Surroundings& here,
                                                  const Candidate& candidate) {
  const auto there = surroundings(*candidate.place);
  if (!there) {
    ++counters_.surfaces_gone;
    return std::nullopt;
  }
  ++counters_.proposed;
  const Verification found = verify_loop(here, *there, candidate.yaw_rad, config_.context, config_.verification);
  ++counters_.verdicts[static_cast<std::size_t>(found.verdict)];
  if (found.verdict != LoopVerdict::accepted) return std::nullopt;
  return between_bodies(*candidate.place, query, found);
}

// The first candidate that holds.
std::optional<LoopMeasurement> LoopFinder::close(const LoopPlace& query, std::size_t& verifications) {
  const std::vector<Candidate> candidates = candidates_of(query);
  if (candidates.empty()) return std::nullopt;
  const auto here = surroundings(query);
  if (!here) {
    ++counters_.surfaces_gone;
    return std::nullopt;
  }
  for (const Candidate& candidate : candidates) {
    ++verifications;
    if (auto loop = verify(query, *here, candidate)) return loop;
  }
  return std::nullopt;
}

bool LoopFinder::closed_near(const LoopPlace& query) const {
  return std::any_of(closed_at_m_.begin(), closed_at_m_.end(),
                     [&](double at_m) { return std::abs(at_m - query.path_m) < config_.loop_spacing_m; });
}

std::vector<LoopMeasurement> LoopFinder::find() {
  std::vector<LoopMeasurement> out;
  std::size_t verifications = 0;
  for (std::size_t i = 0; i < config_.key_frames_per_call && !waiting_.empty(); ++i) {
    if (verifications >= config_.verifications_per_call) break;
    const LoopPlace query = std::move(waiting_.back());
    waiting_.pop_back();
    if (closed_near(query)) continue;
    const auto loop = close(query, verifications);
    if (!loop) continue;
    out.push_back(*loop);
    closed_at_m_.push_back(query.path_m);
    // Whoever still waits is at most this many key frames old.
    if (closed_at_m_.size() > config_.waiting_max) closed_at_m_.pop_front();
  }
  return out;
}

}  // namespace lxd
