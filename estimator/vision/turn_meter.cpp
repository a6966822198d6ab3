// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/turn_meter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lxd {
namespace {

// Images farther apart have few features in common, and nobody knows the way between them.
constexpr Duration kApartMax = Duration::from_ns(300'000'000);
// Of a feature whose distance nobody knows: most are farther than 3 m.
constexpr double kUnknownRhoSigma = 0.3;
// What the way between two images is wrong by even where it was measured, an axis.
constexpr double kTurnShiftFloor_m = 0.003;

}  // namespace

TurnMeter::TurnMeter(const MountedCamera& camera, double pixel_sigma_px, Arena& arena)
    : sigma_rad_(std::numbers::sqrt2 * pixel_sigma_px / camera.model.intrinsics().focal_px.mean()),
      before_(arena.take<Remembered>("remembered features", kFeaturesMax)),
      pairs_(arena.take<TurnPair>("features in two images", kFeaturesMax)) {}

// Both have their features in the order of their birth.
std::span<const TurnPair> TurnMeter::pairs_with(std::span<const FeatureTrack> tracks) noexcept {
  std::size_t count = 0, cursor = 0;
  for (const FeatureTrack& track : tracks) {
    if (track.stage == FeatureStage::rejected) continue;
    std::size_t at = cursor;
    while (at < count_ && before_[at].id != track.id) ++at;
    if (at == count_) continue;
    cursor = at + 1;
    pairs_[count++] = {before_[at].bearing, track.bearing, before_[at].rho, before_[at].rho_sigma};
  }
  return pairs_.first(count);
}

void TurnMeter::remember(const ConcludedImage& image) noexcept {
  stamp_ = image.stamp;
  T_world_camera_ = image.T_world_camera;
  count_ = 0;
  const Pose T_camera_world = image.T_world_camera.inverse();
  for (const FeatureTrack& track : image.tracks) {
    if (track.stage == FeatureStage::rejected) continue;
    Remembered& kept = before_[count_++] = {track.id, track.bearing, 0, kUnknownRhoSigma};
    if (track.source == DepthSource::none || track.anchor == kNoFrame) continue;
    const InverseDepth depth = shifted(track.point, T_camera_world * image.window[track.anchor].T_world_camera).depth;
    kept.rho = depth.rho;
    kept.rho_sigma = std::sqrt(depth.variance);
  }
}

// R_then_now = R_now_before^T: what perturbs R_now_before on its right turns the camera the other way, about an axis
// that R_now_before takes there.
bool TurnMeter::turn_to(const ConcludedImage& now, double shift_variance_m2, ImageTurn& turn) noexcept {
  TurnGuess guess;
  const TurnExpected expected{now.T_world_camera.inverse() * T_world_camera_,
                              std::sqrt(2 * shift_variance_m2 + kTurnShiftFloor_m * kTurnShiftFloor_m)};
  const bool found =
      count_ > 0 && now.stamp - stamp_ <= kApartMax && guess_turn(pairs_with(now.tracks), expected, sigma_rad_, guess);
  if (found) {
    const Eigen::Matrix3d& R = guess.R_now_before;
    turn = {stamp_, now.stamp, R.transpose(), R * guess.covariance_rad2 * R.transpose()};
  }
  remember(now);
  return found;
}

}  // namespace lxd
