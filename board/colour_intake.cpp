// SPDX-License-Identifier: Apache-2.0
#include "board/colour_intake.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "backend/graph/pose_blend.hpp"

namespace lxd {
namespace {

constexpr std::size_t kOffersMax = 16;  // that wait for a pose: more than a camera takes between two sweeps
constexpr std::size_t kPosesMax = 16;   // that are remembered
// Between poses farther apart nobody knows where the camera was.
constexpr Duration kPosesApart = Duration::from_ns(300'000'000);

// Some of a sweep's points tell as much as all.
constexpr std::size_t kScenePoints = 256;

// 0: it has none.
double scene_of(const SweepOutcome& outcome) {
  std::array<float, kScenePoints> ranges{};
  const std::size_t count = outcome.registered_primary, taken = std::min(count, kScenePoints);
  if (taken == 0) return 0;
  for (std::size_t i = 0; i < taken; ++i)
    ranges[i] = (outcome.registered[i * count / taken].position_m - outcome.lidar_m).norm();
  const auto half = ranges.begin() + static_cast<std::ptrdiff_t>(taken / 2);
  std::nth_element(ranges.begin(), half, ranges.begin() + static_cast<std::ptrdiff_t>(taken));
  return *half;
}

std::optional<double> log_exposure_of(const ColourOffer& offer) {
  if (offer.exposure <= Duration() || !offer.gain) return std::nullopt;
  return std::log(offer.exposure.seconds() * *offer.gain);
}

}  // namespace

void ColourIntake::offer(ColourOffer offer) {
  if (offers_.size() == kOffersMax) offers_.pop_front();
  offers_.push_back(std::move(offer));
}

void ColourIntake::place(const SweepOutcome& outcome, RigTime begin) {
  if (path_.size() == kPosesMax) path_.pop_front();
  if (const double scene_m = scene_of(outcome); scene_m > 0) scene_m_ = scene_m;
  path_.push_back({outcome.stamp, outcome.T_world_body, outcome.tracked});
  const Pose T_body_camera{outcome.R_body_camera, camera_in_body_m_};
  for (; !offers_.empty() && offers_.front().instant - outcome.camera_delay <= outcome.stamp; offers_.pop_front())
    choose(offers_.front(), offers_.front().instant - outcome.camera_delay, T_body_camera, begin);
}

void ColourIntake::choose(const ColourOffer& offer, RigTime taken, const Pose& T_body_camera, RigTime begin) {
  const auto next = std::ranges::lower_bound(path_, taken, {}, &Placed::stamp);
  if (next == path_.begin() || next == path_.end()) return;
  const Placed &before = *std::prev(next), &after = *next;
  const Duration apart = after.stamp - before.stamp;
  if (!before.tracked || !after.tracked || apart > kPosesApart || apart <= Duration()) return;
  const double share = (taken - before.stamp).seconds() / apart.seconds();
  KeyImage image;
  image.stamp = taken;
  image.T_world_camera = blend(before.T_world_body, after.T_world_body, share) * T_body_camera;
  image.scene_m = scene_m_;
  if (!images_.wants(image.T_world_camera, scene_m_, begin)) return;
  image.turn_radps = Log(before.T_world_body.R.transpose() * after.T_world_body.R).norm() / apart.seconds();
  image.log_exposure = log_exposure_of(offer);
  image.rgb = offer.key_pixels();
  if (!image.rgb.empty()) images_.add(std::move(image));
}

void ColourIntake::begin_again() {
  offers_.clear();
  path_.clear();
  images_.clear();
  scene_m_ = 0;
}

}  // namespace lxd
