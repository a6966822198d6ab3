// SPDX-License-Identifier: Apache-2.0
// Is the body where the update says? Which sweeps hold the pose, which may be mapped, and what a place has to stand
// that was found after a silence.
#include "estimator/odometry.hpp"
#include "estimator/pierced_surfaces.hpp"

namespace lxd {
namespace {

// Least agreement with the map of a sweep that may move the pose. Street, forest, room and hall have 0.7 and more;
// noise in place of a sweep 0.3 at most.
constexpr double kAgreementMin = 0.45;
constexpr double kAgreementInDoubt = 0.6;  // likewise, when a place that merely looks alike could have been found
constexpr Duration kUnwatched = Duration::from_ns(300'000'000);  // a turn that nothing measured for longer is not known
constexpr double kAstraySigma_m = 0.5;        // beyond, the image of the last sweep does not reach: the place is sought
constexpr std::uint32_t kLostSweepsMax = 10;  // beyond, what is seen begins a surface of its own
constexpr std::uint32_t kSoughtSweepsMax = 200;  // likewise, when its place is sought
// What is seen where nothing is known speaks against a place, too: of all returns, in place of those that meet a
// surface. The right one has 0.78 and more among parked cars and in streets, wrong ones 0.45 to 0.55.
constexpr double kFitOnTrialMin = 0.65;
// Beams through known surfaces, more than what passes by, or has gone meanwhile, makes them: the right place has 0.02
// at most among parked cars, one that is metres behind it 0.05 and more.
constexpr double kPiercedMax = 0.03, kTimesUsual = 2;
constexpr std::size_t kBeamsOnTrial = 300, kBeamsAlways = 30;  // that are looked at
constexpr double kUsualGain = 1.0 / 8;                         // of a sweep, in the running mean

// What a wrong place said is no knowledge, of the motion least of all.
State at_rest(State x, MotionSource source) {
  x.v.setZero();
  if (source == MotionSource::constant_velocity) x.b_g.setZero();
  return x;
}

}  // namespace

// What the surfaces say against where the update ended.
bool Odometry::belongs() {
  if (enough_features()) return true;
  if (outcome_.agreement < (in_doubt() ? kAgreementInDoubt : kAgreementMin)) return false;
  if (!trial_.open()) return true;
  const double known = static_cast<double>(outcome_.points_used) / static_cast<double>(registration_count_);
  if (known * outcome_.agreement < kFitOnTrialMin) return false;
  follow(filter_.state());
  return pierced(kBeamsOnTrial) < kPiercedMax + kTimesUsual * usually_pierced_;
}

double Odometry::pierced(std::size_t beams) const {
  return pierced_share(registration_.first(registration_count_), path_, setup_.T_body_lidar.p, map_, beams);
}

// May the body be metres from where it is predicted?
bool Odometry::astray() const { return in_doubt() && filter_.sigma(kPosition) > kAstraySigma_m; }

// A place that is to be found after a silence is on trial.
void Odometry::begin_trial() {
  if (lost_sweeps_ > 0 || !astray()) return;
  trial_.begin();
  doubt_ = filter_.covariance();
}

// After a silence of all sensors, or lost. (Where the geometry leaves a direction open the doubt may be as large, but
// nothing that looks alike is taken for anything there.)
bool Odometry::in_doubt() const {
  return lost_sweeps_ > 0 || (outcome_.source == MotionSource::constant_velocity && end_ - last_end_ > kUnwatched);
}

// A sweep that does not hold the pose would put its surfaces anywhere; but a carrier that has left its map for good
// must begin another. One that may be metres from where it is predicted has long to be sought before, and whoever wants
// another map meanwhile begins again.
bool Odometry::may_insert() const {
  if (registration_count_ == 0) return false;
  if (lost_sweeps_ == 0) return !trial_.open();
  return lost_sweeps_ > (trial_.open() ? kSoughtSweepsMax : kLostSweepsMax);
}

// A sweep that has no returns tells nothing of whether the carrier is in its map.
void Odometry::count_lost() {
  if (outcome_.tracked) {
    lost_sweeps_ = 0;
    search_rest_.found();
    if (registration_count_ == 0) return;
    if (!trial_.open()) usually_pierced_ += kUsualGain * (pierced(kBeamsAlways) - usually_pierced_);
    trial_.held();
  } else if (registration_count_ > 0) {
    ++lost_sweeps_;
    if (trial_.failed()) filter_.reset(at_rest(filter_.state(), outcome_.source), doubt_);
  }
}

}  // namespace lxd
