// SPDX-License-Identifier: Apache-2.0
// The features' lives in the real-time thread (paper, "Visual Feature Lifecycle and Depth Filtering" and "Mesh-Assisted
// Visual Depth Association"). For every image: begin() with its features, landmarks() into the update, conclude() with
// the pose that the update gave. Storage is lent at construction; nothing allocates.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "estimator/vision/config.hpp"
#include "estimator/vision/feature_frame.hpp"
#include "estimator/vision/feature_track.hpp"
#include "estimator/vision/feature_window.hpp"
#include "estimator/vision/reprojection.hpp"
#include "mapping/surface_map.hpp"
#include "rt/arena.hpp"

namespace lxd {

// Since the start, but for the stages, which are of the present image.
struct FeatureCounters {
  std::uint32_t candidates = 0, mature = 0, rejected_now = 0;
  std::uint64_t taken_up = 0, lost = 0, matured = 0, rejected = 0;
  std::uint64_t rays = 0, surfaces = 0, contradictions = 0, triangulated = 0, anchors_shifted = 0;
};

class FeatureStore {
 public:
  FeatureStore(const MountedCamera& camera, const VisionConfig& config, Arena& arena);

  // The camera is found to be mounted so: the frames in which features are anchored have looked there, too.
  void mount(const Eigen::Matrix3d& R_body_camera) noexcept;

  // Everything is forgotten: the world begins again, or the pose has leapt.
  void clear();

  // The next image: known features get their new pixels, new ones are taken up, those that are not in it are lost.
  void begin(const FeatureFrame& frame) noexcept;

  // The mature features of the image. Valid until the next call.
  std::span<const VisualObservation> landmarks() noexcept;

  // After the update: T_world_body at the image's time. `scale` is that of the residuals (visual_scale), so that a pose
  // that is off for all features rejects none. Innovations are judged, distances filtered, found in the map or
  // triangulated, and the frame enters the window when it is worth it.
  void conclude(const Pose& T_world_body, const SurfaceMap& map, double scale) noexcept;

  [[nodiscard]] std::span<const FeatureTrack> tracks() const { return tracks_[now_].first(count_); }
  [[nodiscard]] const FeatureWindow& window() const { return window_; }
  [[nodiscard]] const FeatureCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] std::span<FeatureTrack> active() { return tracks_[now_].first(count_); }
  [[nodiscard]] VisualObservation landmark_of(const FeatureTrack& track) const;
  [[nodiscard]] double bearing_sigma_rad() const;
  void judge(FeatureTrack& track, const Pose& T_world_camera, double scale);
  void condemn(FeatureTrack& track);
  void find_surface(FeatureTrack& track, const Pose& T_world_camera, const SurfaceMap& map);
  void find_by_triangulation(FeatureTrack& track);
  void accept_surface(FeatureTrack& track, const InverseDepth& observed);
  void ripen(FeatureTrack& track);
  void admit_frame(const Pose& T_world_camera);
  void shift_anchor(FeatureTrack& track);
  void count_stages();

  MountedCamera camera_;
  VisionConfig config_;
  std::array<std::span<FeatureTrack>, 2> tracks_;  // of this image and of the last one, in turns
  std::span<VisualObservation> landmarks_;
  std::uint32_t now_ = 0, count_ = 0;
  RigTime stamp_;
  FeatureWindow window_;
  FeatureCounters counters_;
};

}  // namespace lxd
