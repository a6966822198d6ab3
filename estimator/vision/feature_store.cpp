// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/feature_store.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/vision/triangulation.hpp"
#include "mapping/ray_cast.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kImagesMin = 3;   // in which a feature was seen before it takes part (paper)
constexpr double kMatureRelative = 0.1;   // largest sigma of the inverse distance, as a share of it,
constexpr double kMatureSigma = 0.01;     // and beside that, 1/m: at 420 px and 0.5 m of way 2 px
constexpr double kInnovationGate = 13.8;  // chi^2 of two degrees of freedom at 0.1 %
constexpr double kSurfaceGate = 9;        // squared sigmas between two rays at one feature
constexpr double kUnseenInflation = 4;    // variance of surfaces between returns
constexpr float kSuspicionAllowance = 5;  // README: squared innovation that raises no suspicion; on average it is 2
constexpr float kSuspicionMax = 25;       // at which a feature is rejected
constexpr float kInnovationMax = 25;      // of one image: a single mistake is not yet a moving object
constexpr double kIncidenceMin = 0.05;    // cosine: flatter rays are no measurement

}  // namespace

FeatureStore::FeatureStore(const MountedCamera& camera, const VisionConfig& config, Arena& arena)
    : camera_(camera),
      config_(config),
      tracks_{arena.take<FeatureTrack>("features", kFeaturesMax), arena.take<FeatureTrack>("features", kFeaturesMax)},
      landmarks_(arena.take<VisualObservation>("feature landmarks", kFeaturesMax)) {}

void FeatureStore::clear() {
  count_ = 0;
  window_.clear();
}

void FeatureStore::mount(const Eigen::Matrix3d& R_body_camera) noexcept {
  window_.turn_cameras(camera_.T_body_camera.R.transpose() * R_body_camera);
  camera_.T_body_camera.R = R_body_camera;
}

double FeatureStore::bearing_sigma_rad() const {
  return config_.pixel_sigma_px / camera_.model.intrinsics().focal_px.mean();
}

// Both images have their features in the order of their birth, so that the search mostly finds the next one.
void FeatureStore::begin(const FeatureFrame& frame) noexcept {
  const std::span<const FeatureTrack> before = tracks();
  now_ ^= 1;
  const std::uint32_t known = count_;
  std::size_t cursor = 0, kept = 0;
  count_ = 0;
  for (const Feature& feature : frame.features()) {
    if (!feature.pixel_px().allFinite() || !feature.direction().allFinite()) continue;
    const auto same = [&](const FeatureTrack& track) { return track.id == feature.id; };
    auto at = std::find_if(before.begin() + static_cast<std::ptrdiff_t>(cursor), before.end(), same);
    if (at == before.end()) at = std::find_if(before.begin(), before.end(), same);
    FeatureTrack& track = tracks_[now_][count_++];
    if (at != before.end()) {
      track = *at;
      cursor = static_cast<std::size_t>(at - before.begin()) + 1;
      ++kept;
    } else {
      track = {};
      track.id = feature.id;
      track.seen_in.fill(kNoFrame);
    }
    track.pixel = feature.pixel_px();
    track.bearing = feature.direction().normalized();
    ++track.images;
  }
  counters_.lost += known - kept;
  counters_.taken_up += count_ - kept;
  stamp_ = frame.stamp;
}

// p = c + R b / rho. Its covariance: the distance's along the ray, and the anchor's pose and bearing.
VisualObservation FeatureStore::landmark_of(const FeatureTrack& track) const {
  const Pose& T = window_[track.anchor].T_world_camera;
  const double distance_m = 1 / track.point.depth.rho;
  const Eigen::Vector3d d = T.R * track.point.bearing;
  const Eigen::Matrix3d along = d * d.transpose(), across = Eigen::Matrix3d::Identity() - along;
  const double square = distance_m * distance_m, bearing = bearing_sigma_rad();
  const double turn = config_.anchor_sigma_rad * config_.anchor_sigma_rad + bearing * bearing;
  return {T.p + distance_m * d,
          square * square * track.point.depth.variance * along + square * turn * across +
              config_.anchor_sigma_m * config_.anchor_sigma_m * Eigen::Matrix3d::Identity(),
          track.pixel};
}

std::span<const VisualObservation> FeatureStore::landmarks() noexcept {
  std::size_t count = 0;
  for (const FeatureTrack& track : tracks())
    if (track.stage == FeatureStage::mature) landmarks_[count++] = landmark_of(track);
  return landmarks_.first(count);
}

void FeatureStore::conclude(const Pose& T_world_body, const SurfaceMap& map, double scale) noexcept {
  const Pose T_world_camera = T_world_body * camera_.T_body_camera;
  if (!T_world_camera.R.allFinite() || !T_world_camera.p.allFinite()) return;
  for (FeatureTrack& track : active())
    if (track.anchor != kNoFrame && track.source != DepthSource::none) judge(track, T_world_camera, scale);
  if (window_.wants({T_world_camera, stamp_})) admit_frame(T_world_camera);
  const std::uint64_t rays_end = counters_.rays + static_cast<std::uint64_t>(config_.rays_per_image);
  for (FeatureTrack& track : active()) {
    if (track.stage != FeatureStage::candidate || track.anchor == kNoFrame) continue;
    if (!track.no_surface && counters_.rays < rays_end) find_surface(track, T_world_camera, map);
    if (track.source == DepthSource::none) find_by_triangulation(track);
    ripen(track);
  }
  count_stages();
}

// A cumulated sum (Page 1954) of squared innovations: one that lies is noticed at once, one that creeps in time.
void FeatureStore::judge(FeatureTrack& track, const Pose& T_world_camera, double scale) {
  VisualResidual residual;
  const Pose& T = T_world_camera;
  PathKnot knot{};  // of an instant
  knot.R = T.R;
  knot.p = T.p;
  knot.turn.setIdentity();
  const bool visible = reproject(landmark_of(track), knot, {camera_.model, Pose{}}, config_.pixel_sigma_px, residual);
  const double squared = visible ? squared_ratio(residual) / (scale * scale) : kInnovationMax;
  const float excess = std::min(static_cast<float>(squared), kInnovationMax) - kSuspicionAllowance;
  track.suspicion = std::max(0.0f, track.suspicion + excess);
  if (track.suspicion > kSuspicionMax) condemn(track);
  if (track.stage == FeatureStage::rejected || track.source == DepthSource::none) return;
  const double noise_px = std::numbers::sqrt2 * config_.pixel_sigma_px * scale;  // of this pixel and the anchor's
  update_by_pixel(track.point, T.inverse() * window_[track.anchor].T_world_camera, camera_.model, track.pixel, noise_px,
                  kInnovationGate);
}

// The ray may have met another surface than the feature's, at an edge: it gets a second life by triangulation.
void FeatureStore::condemn(FeatureTrack& track) {
  if (track.stage == FeatureStage::rejected) return;
  track.suspicion = 0;
  if (track.source == DepthSource::surface) {
    track.stage = FeatureStage::candidate;
    track.source = DepthSource::none;
    track.no_surface = true;
    ++counters_.contradictions;
    return;
  }
  track.stage = FeatureStage::rejected;
  ++counters_.rejected;
}

// The frame becomes the window's newest; the oldest leaves, and who is anchored there moves on.
void FeatureStore::admit_frame(const Pose& T_world_camera) {
  if (window_.full()) {
    for (FeatureTrack& track : active())
      if (track.anchor == window_.oldest()) shift_anchor(track);
    window_.pop_oldest();
  }
  window_.push({T_world_camera, stamp_});
  for (FeatureTrack& track : active()) {
    track.see(window_.newest());
    if (track.anchor != kNoFrame) continue;
    track.anchor = window_.newest();
    track.point.bearing = track.bearing;
  }
}

// To the next frame in which it was seen; without one it waits for the newest.
void FeatureStore::shift_anchor(FeatureTrack& track) {
  const std::uint32_t old = track.anchor;
  std::uint32_t next = old + 1;
  while (next <= window_.newest() && !track.was_seen_in(next)) ++next;
  ++counters_.anchors_shifted;
  if (next > window_.newest()) {
    track.anchor = kNoFrame;
    track.source = DepthSource::none;
    if (track.stage == FeatureStage::mature) track.stage = FeatureStage::candidate;
    return;
  }
  track.anchor = next;
  if (track.source == DepthSource::none)
    track.point.bearing = track.bearing_in(next);
  else
    track.point = shifted(track.point, window_[next].T_world_camera.inverse() * window_[old].T_world_camera);
}

// A ray through the present pixel; where it hits is carried into the anchor's frame.
void FeatureStore::find_surface(FeatureTrack& track, const Pose& T_world_camera, const SurfaceMap& map) {
  ++counters_.rays;
  const Eigen::Vector3d direction = (T_world_camera.R * track.bearing).normalized();
  RayHit hit;
  if (!cast_ray(map, {T_world_camera.p, direction, config_.range_max_m}, hit) || !hit.front) return;
  const double cosine = -hit.normal.cast<double>().dot(direction);
  if (!(cosine > kIncidenceMin) || !(hit.distance_m * kInverseDistanceMax > 1)) return;
  // A bearing that is off by its sigma meets an inclined surface nearer or farther.
  const double slide_m = hit.distance_m * bearing_sigma_rad() * std::sqrt(1 - std::min(1.0, cosine * cosine)) / cosine;
  const double variance = (hit.seen ? 1.0 : kUnseenInflation) * hit.variance_m2 + slide_m * slide_m;
  const AnchoredPoint here{track.bearing, inverse_of(hit.distance_m, variance)};
  accept_surface(track, shifted(here, window_[track.anchor].T_world_camera.inverse() * T_world_camera).depth);
}

// Rays at one surface share its error: of two that agree the better one counts. What was triangulated is independent.
void FeatureStore::accept_surface(FeatureTrack& track, const InverseDepth& observed) {
  const bool agrees =
      track.source == DepthSource::none || squared_difference(track.point.depth, observed) < kSurfaceGate;
  if (!agrees) {
    ++counters_.contradictions;
    track.no_surface = true;
    if (track.source == DepthSource::surface) track.source = DepthSource::none;
    return;
  }
  if (track.source == DepthSource::none) ++counters_.surfaces;
  if (track.source == DepthSource::triangulation)
    track.point.depth = fused(track.point.depth, observed);
  else if (track.source == DepthSource::none || observed.variance < track.point.depth.variance)
    track.point.depth = observed;
  track.source = DepthSource::surface;
}

void FeatureStore::find_by_triangulation(FeatureTrack& track) {
  std::array<Sighting, kWindowFrames> sightings;
  std::size_t count = 0;
  for (std::uint32_t frame = window_.oldest(); frame <= window_.newest(); ++frame)
    if (track.was_seen_in(frame)) sightings[count++] = {window_[frame].T_world_camera, track.bearing_in(frame)};
  const double sigma = Eigen::Vector2d(bearing_sigma_rad(), config_.anchor_sigma_rad).norm();
  Triangulation found;
  if (!triangulate(std::span(sightings).first(count), sigma, config_.parallax_min_rad, found)) return;
  const Pose& anchor = window_[track.anchor].T_world_camera;
  const Eigen::Vector3d way = found.p_world_m - anchor.p, d = way.normalized();
  track.point.bearing = anchor.R.transpose() * d;
  track.point.depth = inverse_of(way.norm(), d.dot(found.covariance_m2 * d));
  track.source = DepthSource::triangulation;
  ++counters_.triangulated;
}

void FeatureStore::ripen(FeatureTrack& track) {
  if (track.source == DepthSource::none || track.images < kImagesMin) return;
  const double sigma_max = kMatureRelative * track.point.depth.rho + kMatureSigma;
  if (!(track.point.depth.variance < sigma_max * sigma_max)) return;
  track.stage = FeatureStage::mature;
  ++counters_.matured;
}

void FeatureStore::count_stages() {
  const auto count = [this](FeatureStage stage) {
    return static_cast<std::uint32_t>(std::count_if(
        tracks().begin(), tracks().end(), [stage](const FeatureTrack& track) { return track.stage == stage; }));
  };
  counters_.candidates = count(FeatureStage::candidate);
  counters_.mature = count(FeatureStage::mature);
  counters_.rejected_now = count(FeatureStage::rejected);
}

}  // namespace lxd
