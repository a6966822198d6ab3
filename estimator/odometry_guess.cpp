// SPDX-License-Identifier: Apache-2.0
// The rotation guess as the odometry uses it: a second place for the iterations to start from. The guess sees the same
// returns as the update does, so it is no measurement of its own; where the map agrees better with it than with the
// prediction, the update begins there. After a silence in which the body may have gone metres, the map is asked for
// more places round about.
#include <algorithm>
#include <array>
#include <cmath>

#include "estimator/odometry.hpp"
#include "estimator/place_search.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kFitPoints = 300;       // thinned points that judge a start
constexpr std::uint32_t kCoarseFitPoints = 75;  // that judge a node of the search
constexpr double kTurnMin_rad = 0.01;           // a prediction that is wrong by less is within reach of the update
constexpr double kAstraySigmas = 3;             // as far the place is sought

// Moved and turned as the world's axes are, whose z is about up.
StateVector offset_of(const State& x, const PlaceOffset& offset) {
  StateVector dx = StateVector::Zero();
  dx.segment<3>(kTheta) = x.R.transpose() * Eigen::Vector3d(0, 0, offset.yaw_rad);
  dx.segment<3>(kPosition) = Eigen::Vector3d(offset.x_m, offset.y_m, 0);
  return dx;
}

}  // namespace

// The image of a sweep that has been registered, deskewed to its end.
void Odometry::remember(std::span<const MapPoint> points) {
  if (!setup_.estimator.rotation_guess) return;
  const Pose T_world_image = filter_.state().pose() * setup_.T_body_lidar;
  T_image_world_ = T_world_image.inverse();
  image_end_ = end_;
  const Eigen::Matrix3f R = T_image_world_.R.cast<float>();
  const Eigen::Vector3f origin = (T_world_image.p - path_.origin()).cast<float>();
  RangeImage& image = guess_.previous();
  image.clear();
  const std::size_t stride = points.size() / RotationGuess::kImagePointsMax | 1;  // odd: beams come in powers of two
  for (std::size_t i = 0; i < points.size(); i += stride) image.add(R * (points[i].position_m - origin));
  image.finish();
}

std::span<const GuessSample> Odometry::guess_samples() {
  const std::size_t stride = registration_count_ / guess_samples_.size() + 1;
  const double span_s = (end_ - begin_).seconds(), since_s = (end_ - image_end_).seconds();
  std::size_t count = 0;
  for (std::size_t i = 0; i < registration_count_; i += stride) {
    const RegistrationPoint& p = registration_[i];
    const double before_end_s = std::max(0.0, span_s - 1e-9 * p.offset_ns);
    guess_samples_[count++] = {(T_image_world_ * path_.to_world(p.p_body_m, p.offset_ns)).cast<float>(),
                               static_cast<float>(std::clamp(1 - before_end_s / since_s, 0.0, 1.0))};
  }
  return guess_samples_.first(count);
}

// Mean agreement of the sweep with the map, 0..1, if the state at its end were x.
double Odometry::fit_of(const State& x, FitDetail detail) {
  follow(x);
  const std::uint32_t points = detail == FitDetail::fine ? kFitPoints : kCoarseFitPoints;
  const std::uint32_t stride = registration_count_ / points + 1;
  double sum = 0;
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < registration_count_; i += stride, ++count) {
    SurfaceHit hit;
    if (!surface_of(registration_[i], path_, setup_.T_body_lidar.p, map_, hit)) continue;
    const double ratio = static_cast<double>(hit.distance_m) / kAgreementTolerance_m;
    sum += 1 / (1 + ratio * ratio);
  }
  return sum / std::max(count, 1u);
}

void Odometry::guess_rotation() {
  if (!setup_.estimator.rotation_guess) return;
  follow(filter_.state());
  const auto sigma = [this](StateBlock of) { return filter_.sigma(of); };
  const RotationGuessResult guess = guess_.seek(guess_samples(), {sigma(kPosition), in_doubt() ? sigma(kTheta) : 0});
  const bool turned = guess.valid && guess.rotation_rad.norm() >= kTurnMin_rad;
  if (!turned && !astray()) return;
  const State prior = filter_.state();
  const Eigen::Vector3d turn_world = T_image_world_.R.transpose() * guess.rotation_rad;
  double fit = fit_of(prior, FitDetail::fine);
  const auto try_start = [&](const StateVector& dx, double fit_there) {
    if (!(fit_there > fit)) return;
    fit = fit_there;
    filter_.start_at(dx);
  };
  if (turned) {
    const StateVector turn = filter_.expected(kTheta, prior.R.transpose() * turn_world);
    const StateVector both = turn + filter_.expected(kPosition, T_image_world_.R.transpose() * guess.translation_m);
    try_start(turn, fit_of(boxplus(prior, turn), FitDetail::fine));
    try_start(both, fit_of(boxplus(prior, both), FitDetail::fine));
  }
  if (!astray() || !search_rest_.may_seek()) return;
  const auto offset = [&](const PlaceOffset& at) { return offset_of(prior, at); };
  const std::array<double, 2> yaws{0, turn_world.z()};
  const auto fit_at = [&](const PlaceOffset& at, FitDetail detail) {
    return fit_of(boxplus(prior, offset(at)), detail);
  };
  const FoundPlace found = seek_place(kAstraySigmas * sigma(kPosition), std::span(yaws).first(turned ? 2 : 1), fit_at);
  try_start(offset(found.offset), found.fit);
}

}  // namespace lxd
