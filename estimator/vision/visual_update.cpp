// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/visual_update.hpp"

#include <algorithm>

namespace lxd {
namespace {

constexpr double kPosesMeet = 2;  // in a residual: the image's and its anchor's, both told from a path

}  // namespace

VisualUpdate::VisualUpdate(const MountedCamera& camera, const VisionConfig& config, Arena& arena)
    : store_(camera, config, arena),
      pixel_sigma_px_(config.pixel_sigma_px),
      given_(camera),
      camera_(camera),
      waiting_(arena.take<FeatureFrame>("waiting images", kWaiting)),
      residuals_(arena.take<VisualResidual>("visual residuals", kFeaturesMax)),
      scratch_(arena.take<float>("visual ratios", kFeaturesMax)),
      alignment_(camera),
      turns_(camera, config.pixel_sigma_px, arena),
      sighted_features_(arena.take<SightedFeature>("sighted features", kFeaturesMax)) {}

void VisualUpdate::add(const FeatureFrame& frame) noexcept {
  if (waiting_count_ == waiting_.size()) {
    ++counts_.crowded;
    forget_first();
  }
  waiting_[waiting_count_++] = frame;
}

void VisualUpdate::forget_first() noexcept {
  std::copy(waiting_.begin() + 1, waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_count_), waiting_.begin());
  --waiting_count_;
}

void VisualUpdate::drop_late(RigTime from) noexcept {
  while (waiting_count_ > 0 && (taken(waiting_[0]) < from - kLateMax || waiting_[0].stamp <= stamp_)) {
    ++counts_.late;
    forget_first();
  }
}

// As it has been found by now.
void VisualUpdate::mount() noexcept {
  if (camera_.T_body_camera.R == alignment_.R_body_camera()) return;
  camera_.T_body_camera.R = alignment_.R_body_camera();
  store_.mount(camera_.T_body_camera.R);
}

bool VisualUpdate::begin(RigTime from, RigTime to) noexcept {
  drop_late(from);
  sighted_ = {};
  turn_.reset();
  mount();
  bool found = false;
  for (; waiting(to); forget_first()) {
    counts_.followed += found;
    found = true;
    stamp_ = waiting_[0].stamp;
    instant_ = taken(waiting_[0]);
    store_.begin(waiting_[0]);
  }
  residual_count_ = 0;
  landmarks_ = found ? store_.landmarks() : std::span<const VisualObservation>();
  counts_.used += found;
  return found;
}

NormalEquations VisualUpdate::sums(const PathKnot& knot, const Vector6d& path_variance, double kernel_sigmas) noexcept {
  residual_count_ = 0;
  for (const VisualObservation& landmark : landmarks_)
    residual_count_ += reproject(landmark, knot, camera_, pixel_sigma_px_, residuals_[residual_count_]);
  const auto found = residuals_.first(residual_count_);
  scale_ = visual_scale(found, scratch_);
  NormalEquations sums = accumulate(found, scale_, kernel_sigmas);
  marginalise(kPosesMeet * path_variance, sums);
  return sums;
}

void VisualUpdate::conclude(const Pose& T_world_body, const Vector6d& path_variance, const SurfaceMap& map) noexcept {
  store_.conclude(T_world_body, map, scale_);
  const Pose T_world_camera = T_world_body * camera_.T_body_camera;
  ImageTurn turn;
  if (!alignment_.known() && turns_.turn_to({stamp_, T_world_camera, store_.tracks(), store_.window()},
                                            path_variance.tail<3>().maxCoeff(), turn))
    turn_ = turn;
  sighted_ = {stamp_, T_world_camera, sight(store_.tracks(), store_.window(), T_world_camera, sighted_features_)};
}

}  // namespace lxd
