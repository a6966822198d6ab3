// SPDX-License-Identifier: Apache-2.0
// The camera's part of a sweep's update: images wait here for the sweep in whose time they were taken; the newest of
// them takes part, with every mature feature, as of its own time. Real-time thread only; memory from the arena.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "estimator/vision/camera_alignment.hpp"
#include "estimator/vision/feature_store.hpp"
#include "estimator/vision/reprojection.hpp"
#include "estimator/vision/sighted_image.hpp"

namespace lxd {

struct VisualCounts {
  std::uint64_t late = 0;      // images older than the sweep by more than kLateMax, or than the one before: dropped
  std::uint64_t crowded = 0;   // images that found no room to wait
  std::uint64_t followed = 0;  // images whose features were followed, and that had a newer one beside them
  std::uint64_t used = 0;      // images that took part in an update
};

class VisualUpdate {
 public:
  static constexpr std::size_t kWaiting = 8;
  static constexpr Duration kLateMax = Duration::from_ns(150'000'000);  // before a sweep's begin: still used

  VisualUpdate(const MountedCamera& camera, const VisionConfig& config, Arena& arena);

  // In the order of time.
  void add(const FeatureFrame& frame) noexcept;

  // The image that takes part in the sweep of [from, to]; nothing: there is none. Its landmarks are kept.
  bool begin(RigTime from, RigTime to) noexcept;
  // Does an image wait that was taken by `until`?
  [[nodiscard]] bool waiting(RigTime until) const { return waiting_count_ > 0 && taken(waiting_[0]) <= until; }
  // When the image that took part last was taken, as far as was known when it did.
  [[nodiscard]] RigTime instant() const { return instant_; }

  // Of the landmarks, when the body was as the knot says at the image's time, a pose that may be off by
  // `path_variance` against the sweep's end.
  [[nodiscard]] NormalEquations sums(const PathKnot& knot, const Vector6d& path_variance,
                                     double kernel_sigmas) noexcept;
  [[nodiscard]] std::uint32_t residuals() const { return residual_count_; }  // of the last sums()

  // After the update: the body at the image's instant. path_variance as in sums().
  void conclude(const Pose& T_world_body, const Vector6d& path_variance, const SurfaceMap& map) noexcept;

  // The turn since the image before, which its features tell; nothing: they do not, or nobody wants to know.
  [[nodiscard]] const ImageTurn* turn() const { return turn_ ? &*turn_ : nullptr; }
  [[nodiscard]] CameraAlignment& alignment() { return alignment_; }
  [[nodiscard]] const CameraAlignment& alignment() const { return alignment_; }

  // Of the image that took part in the last sweep; none if there was none.
  [[nodiscard]] const SightedImage& sighted() const { return sighted_; }

  // The world begins again: features are forgotten, images wait on.
  void clear() {
    store_.clear();
    turns_.clear();
    turn_.reset();
    alignment_.forget_path();
    sighted_ = {};
  }
  // Another recording begins: neither features nor images are left.
  void forget() {
    clear();
    waiting_count_ = 0;
    stamp_ = instant_ = kNever;
    alignment_ = CameraAlignment(given_);
  }

  [[nodiscard]] const VisualCounts& counts() const { return counts_; }
  [[nodiscard]] const FeatureCounters& features() const { return store_.counters(); }

 private:
  [[nodiscard]] RigTime taken(const FeatureFrame& frame) const { return frame.stamp - alignment_.delay(); }
  void drop_late(RigTime from) noexcept;
  void forget_first() noexcept;
  void mount() noexcept;

  FeatureStore store_;
  double pixel_sigma_px_;
  MountedCamera given_, camera_;  // by the rig file, and as it is believed by now
  std::span<FeatureFrame> waiting_;
  std::size_t waiting_count_ = 0;
  std::span<VisualResidual> residuals_;
  std::span<float> scratch_;
  std::span<const VisualObservation> landmarks_;
  std::uint32_t residual_count_ = 0;
  double scale_ = 1;
  RigTime stamp_ = kNever, instant_ = kNever;
  CameraAlignment alignment_;
  TurnMeter turns_;
  std::optional<ImageTurn> turn_;
  std::span<SightedFeature> sighted_features_;
  SightedImage sighted_;
  VisualCounts counts_;
};

}  // namespace lxd
