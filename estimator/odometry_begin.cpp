// SPDX-License-Identifier: Apache-2.0
// How the odometry begins: the first sweep is the world, the second one finds its motion, and with it the IMU's biases.
#include <algorithm>

#include "estimator/odometry.hpp"

namespace lxd {
namespace {

// What is left of the doubt in the motion when the second sweep has found it; without an IMU.
constexpr double kSecondSpeedSigma_mps = 0.3, kSecondRateSigma_radps = 0.2;

StateMatrix rate_covariance(double speed_sigma, double rate_sigma) {
  StateMatrix P = StateMatrix::Zero();
  P.block<3, 3>(kVelocity, kVelocity).diagonal().setConstant(speed_sigma * speed_sigma);
  P.block<3, 3>(kGyroBias, kGyroBias).diagonal().setConstant(rate_sigma * rate_sigma);
  return P;
}

}  // namespace

// The first sweep, or the one that begins again, defines the world; nothing is known of its motion.
void Odometry::begin_with(const Sweep& sweep) {
  map_.clear();
  lost_sweeps_ = 0;
  trial_ = {};
  usually_pierced_ = 0;
  motion_.restart();
  image_in_hand_ = false;
  if (vision_) vision_->clear();
  const Motion::Beginning known = motion_.begin(begin_, end_);
  filter_.reset(known.x, known.P);
  follow(known.x);
  insert();
  std::copy(sweep.points().begin(), sweep.points().end(), first_sweep_.begin());
  first_count_ = sweep.count;
  first_begin_ = sweep.begin;
  phase_ = Phase::second_sweep;
}

// The first sweep as it came, without what the extra LiDAR added.
void Odometry::take_first_again() {
  begin_ = first_begin_;
  end_ = last_end_;
  primary_returns_ = {lidar0_, first_sweep_.first(first_count_), 0};
  extra_returns_ = {};
}

// Two sweeps of a steadily moving carrier are skewed alike, so that they register as they are. The motion found deskews
// the first, which then begins the map anew. False: one of them, or the motion between them, is no beginning.
bool Odometry::bootstrap(const Sweep& sweep) {
  const double dt = (end_ - last_end_).seconds();
  if (dt > setup_.estimator.gap_max_s) return false;
  State first;
  first.R = filter_.state().R;
  (void)motion_.predict(filter_, last_end_, end_);
  begin_ = end_;  // an instant
  guess_rotation();
  register_to_mesh(setup_.estimator.iterations_max);
  take(sweep);
  if (!outcome_.tracked) return false;
  first.v = filter_.state().p / dt;
  first.b_g = -Log(first.R.transpose() * filter_.state().R) / dt;
  StateMatrix P = rate_covariance(kSecondSpeedSigma_mps, kSecondRateSigma_radps);
  P.block<3, 3>(kVelocity, kVelocity) += filter_.covariance().block<3, 3>(kPosition, kPosition) / (dt * dt);
  P.block<3, 3>(kGyroBias, kGyroBias) += filter_.covariance().block<3, 3>(kTheta, kTheta) / (dt * dt);
  motion_.align(first, first_begin_, end_);
  map_.clear();
  filter_.reset(first, P);
  take_first_again();
  follow(first);
  downsample();
  insert();
  take(sweep);
  downsample();
  phase_ = Phase::tracking;
  return true;
}

}  // namespace lxd
