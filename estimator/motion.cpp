// SPDX-License-Identifier: Apache-2.0
#include "estimator/motion.hpp"

#include <algorithm>
#include <cmath>

#include "rt/square.hpp"

namespace lxd {
namespace {

constexpr Duration kReadingGapMax = Duration::from_ns(30'000'000);  // a longer silence of the IMU is bridged otherwise
constexpr Duration kInstant = Duration::from_ns(10'000'000);        // before a time: how long "then" was
constexpr double kGravity_mps2 = 9.80665, kGravitySigma_mps2 = 0.02;  // standard, and how it varies with the place
constexpr Duration kAlignSpan = Duration::from_ns(100'000'000);       // of an IMU that is heard for the first time
// What is known of a MEMS IMU that nobody has calibrated.
constexpr double kGyroBiasSigma_radps = 0.02, kAccelBiasSigma_mps2 = 0.1;
constexpr double kHiddenAcceleration_mps2 = 1.0;
constexpr double kRestSigma_mps2 = 0.05;           // of the mean force over a sweep, against gravity
constexpr double kSetAsideRateSigma_radps = 0.05;  // of the body's rate when the IMU falls silent
// What a carrier may do of which nothing is known; bounds what a long silence may leave open.
constexpr RateSigmas kUnknownRates{5.0, 1.0};

// At rest: the readings of so long scatter by no more than so many times the sensor's own noise.
constexpr Duration kRestSpan = Duration::from_ns(300'000'000);
constexpr std::uint32_t kRestReadings = 15;
constexpr double kRestNoise = 2;
constexpr double kRestSpeed_mps = 0.15, kRestWheel_mps = 0.01;
constexpr double kRestSpeedSigma_mps = 0.02;
constexpr double kRestRateSigma_radps = 1e-3;  // of what still turns at rest
constexpr double kRestGate = 22.46;            // chi-square, 6 degrees of freedom, 0.999

WheelAlignment wheel_alignment_of(const MotionSetup& setup) {
  if (!setup.wheel) return {};
  const WheelModel& wheel = *setup.wheel;
  return {wheel.delay_s, wheel.delay_sigma_s, wheel.speed_sigma_mps, wheel.yaw_rate_sigma_radps};
}

// Velocity is zero, and what the gyroscope reads is its bias; false when the filter knows better.
bool update_at_rest(Ieskf& filter, const Eigen::Vector3d& gyro_radps, double gyro_sigma_radps) {
  Ieskf::Measurement<6> rest;
  rest.r << filter.state().v, filter.state().b_g - gyro_radps;
  rest.H.block<3, 3>(0, kVelocity).setIdentity();
  rest.H.block<3, 3>(3, kGyroBias).setIdentity();
  rest.R.diagonal() << Eigen::Vector3d::Constant(square(kRestSpeedSigma_mps)),
      Eigen::Vector3d::Constant(square(gyro_sigma_radps));
  if (!(filter.surprise(rest) <= kRestGate)) return false;
  filter.correct(rest);
  return true;
}

}  // namespace

Motion::Motion(const MotionSetup& setup, Arena& arena)
    : setup_(setup),
      noise_{setup.estimator.acceleration_density, setup.estimator.angular_acceleration_density},
      imu_(arena),
      wheel_(arena),
      wheel_alignment_(wheel_alignment_of(setup)) {
  if (setup.imu) set_imu_delay(Duration::from_seconds(setup.imu->delay_s));
  wheel_.set_delay(wheel_alignment_.delay());
}

void Motion::set_imu_delay(Duration delay) noexcept {
  imu_delay_ = delay;
  imu_.set_delay(delay);
}

void Motion::add(const InertialReading& reading) noexcept {
  if (!setup_.imu) return;
  newest_inertial_ = std::max(newest_inertial_, reading.t);
  imu_.add({reading.t, R_body_imu_ * reading.rate_radps, R_body_imu_ * reading.force_mps2});
}

void Motion::add(const WheelReading& reading) noexcept {
  if (setup_.wheel) wheel_.add(reading);
}

Motion::Beginning Motion::begin(RigTime from, RigTime to) const noexcept {
  Beginning out;
  out.P.diagonal().segment<3>(kVelocity).setConstant(square(kUnknownRates.speed_mps));
  out.P.diagonal().segment<3>(kGyroBias).setConstant(square(kUnknownRates.rate_radps));
  out.x.R = setup_.R_world_body;
  const ImuHistory::Mean mean = imu_.mean(from, to);
  if (mean.count == 0 || mean.force_mps2.norm() < kGravity_mps2 / 2) return out;
  const Eigen::Vector3d up = out.x.R * mean.force_mps2;
  out.x.R = Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix() * out.x.R;
  out.x.b_g = -mean.rate_radps;
  out.P.diagonal().segment<3>(kGyroBias).setConstant(square(kGyroBiasSigma_radps));
  return out;
}

// The mean force is taken for gravity's: what it has of the carrier's acceleration a and of the bias is what gravity is
// wrong by across. A carrier at rest has no acceleration; of another one a steady acceleration shows by
// |f|^2 = g^2 + a^2, which the biases hide up to 1 m/s^2, a changing one by its scatter. The tilt that it makes
// shortens gravity's vertical part by a^2 / 2 g.
void Motion::align(const State& x, RigTime from, RigTime to) noexcept {
  begun_ = true;
  const ImuHistory::Mean mean = imu_.mean(from, to);
  if (mean.count == 0 || mean.force_mps2.norm() < kGravity_mps2 / 2) return;
  const double excess = std::max(0.0, mean.force_mps2.squaredNorm() - square(kGravity_mps2 + kRestSigma_mps2));
  const double driven = x.v.norm() < kRestSpeed_mps ? 0.0 : kHiddenAcceleration_mps2 + std::sqrt(excess);
  const double across = kRestSigma_mps2 + mean.force_sigma + driven;
  const double along = kGravitySigma_mps2 + square(across) / (2 * kGravity_mps2);
  const Eigen::Vector3d up = (x.R * mean.force_mps2).normalized();
  Calibration c;
  c.b_g = mean.rate_radps + x.b_g;
  c.g = -kGravity_mps2 * up;
  c.P.diagonal().head<6>() << Eigen::Vector3d::Constant(square(kGyroBiasSigma_radps)),
      Eigen::Vector3d::Constant(square(kAccelBiasSigma_mps2));
  c.P.bottomRightCorner<3, 3>() =
      square(across) * Eigen::Matrix3d::Identity() + (square(along) - square(across)) * up * up.transpose();
  aside_ = c;
  aside_since_ = to;
}

void Motion::restart() noexcept {
  aside_.reset();
  forget_path();
  begun_ = inertial_ = false;
  source_ = MotionSource::constant_velocity;
}

void Motion::clear() noexcept {
  restart();
  imu_.clear();
  if (setup_.imu) set_imu_delay(Duration::from_seconds(setup_.imu->delay_s));
  wheel_.clear();
  wheel_alignment_ = wheel_alignment_of(setup_);
  R_body_imu_.setIdentity();
  lacking_rad2_ = turned_rad2_ = 0;
  wheel_.set_delay(wheel_alignment_.delay());
  newest_inertial_ = rolled_until_ = kNever;
}

bool Motion::imu_covers(RigTime from, RigTime to) const noexcept {
  return setup_.imu && imu_.size() > 0 && imu_.covers(from, to, kReadingGapMax);
}

bool Motion::measured(RigTime from, RigTime to) const noexcept {
  if (begun_ && imu_covers(from, to)) return true;
  bool rolled = false;
  wheel_.for_each(from, [&](const WheelReading& reading) {
    rolled = reading.t <= to;
    return false;
  });
  return rolled;
}

void Motion::choose(Ieskf& filter, RigTime from, RigTime to) noexcept {
  const bool covered = imu_covers(from, to);
  if (inertial_ && !covered) set_imu_aside(filter, from);
  if (!inertial_ && begun_ && !aside_ && imu_covers(from - kAlignSpan, to))
    align(filter.state(), from - kAlignSpan, from);
  if (!inertial_ && covered && aside_) take_imu_up(filter, from);
}

void Motion::set_imu_aside(Ieskf& filter, RigTime at) noexcept {
  aside_ = filter.calibration();
  aside_since_ = at;
  Calibration none = *aside_;
  none.b_g = filter.state().b_g - gyro_at(at);
  none.P.setZero();
  none.P.topLeftCorner<3, 3>() = aside_->P.topLeftCorner<3, 3>();
  none.P.diagonal().head<3>().array() += square(kSetAsideRateSigma_radps);
  filter.replace(none);
  inertial_ = false;
}

void Motion::take_imu_up(Ieskf& filter, RigTime at) noexcept {
  const double away_s = std::max(0.0, (at - aside_since_).seconds());
  aside_->P += process_noise(*setup_.imu, away_s).block<9, 9>(kGyroBias, kGyroBias);
  filter.replace(*aside_);
  aside_.reset();
  inertial_ = true;
}

Eigen::Vector3d Motion::gyro_at(RigTime t) noexcept {
  const ImuHistory::Mean mean = imu_.mean(t - kInstant, t);
  return mean.count > 0 ? mean.rate_radps : imu_.value_at(t).rate_radps;
}

// All agree: no reading scatters more than the sensor's own noise does, nothing turns, no wheel rolls, and what the
// filter knows of the speed does not contradict.
bool Motion::is_still(const State& x, RigTime at) const noexcept {
  const RigTime since = at - kRestSpan;
  const ImuHistory::Mean mean = imu_.mean(since, at);
  if (mean.count < kRestReadings || x.v.norm() > kRestSpeed_mps) return false;
  const double root_rate = kRestNoise * std::sqrt(mean.count / kRestSpan.seconds());
  if (mean.rate_sigma > root_rate * setup_.imu->gyro_density) return false;
  if (mean.force_sigma > root_rate * setup_.imu->accel_density) return false;
  if ((mean.rate_radps - x.b_g).norm() > kGyroBiasSigma_radps) return false;
  bool rolls = false;
  wheel_.for_each(since, [&](const WheelReading& reading) {
    rolls = std::abs(reading.speed_mps) > kRestWheel_mps;
    return !rolls;
  });
  return !rolls;
}

// The same readings are told more than once: the mean of the span is said to be as wrong as one that is not.
void Motion::rest(Ieskf& filter, RigTime at) noexcept {
  const Eigen::Vector3d gyro = imu_.mean(at - kRestSpan, at).rate_radps;
  const double sigma = std::max(setup_.imu->gyro_density / std::sqrt(kRestSpan.seconds()), kRestRateSigma_radps);
  rests_ += update_at_rest(filter, gyro, sigma);
}

void Motion::advance(Ieskf& filter, RigTime from, RigTime to) noexcept {
  if (inertial_) {
    for (const InertialSpan& span : imu_.spans(from, to)) filter.predict(span, *setup_.imu);
    return;
  }
  const double dt_s = (to - from).seconds(), known_s = setup_.estimator.gap_max_s;
  if (dt_s <= known_s)
    filter.predict(dt_s, noise_);
  else
    filter.predict_across({dt_s, known_s, kUnknownRates}, noise_);
}

MotionSource Motion::predict(Ieskf& filter, RigTime from, RigTime to) noexcept {
  if (setup_.imu) set_imu_delay(Duration::from_seconds(filter.delay().delay_s()));
  R_body_imu_ = filter.mount().R_body_imu();
  wheel_.set_delay(wheel_alignment_.delay());
  choose(filter, from, to);
  bool rolling = false;
  RigTime at = from;
  wheel_.for_each(from, [&](const WheelReading& reading) {
    if (reading.t > to) return false;
    advance(filter, at, reading.t);
    at = reading.t;
    const Eigen::Vector3d gyro = inertial_ ? gyro_at(at) : Eigen::Vector3d::Zero();
    const bool fits = update_with_wheel(filter, reading, *setup_.wheel, gyro);
    slipping_ += !fits;
    rolling = rolling || fits;
    if (fits) rolled_until_ = reading.t;
    return true;
  });
  if (at < to) advance(filter, at, to);
  if (inertial_ && is_still(filter.state(), to)) rest(filter, to);
  source_ = inertial_ ? MotionSource::imu : rolling ? MotionSource::wheel : MotionSource::constant_velocity;
  return source_;
}

// Between them the readings may have a gap that the path's begin lies before: the mean rate since then serves.
State Motion::steady(const State& end, RigTime to) noexcept {
  State steady = end;
  if (inertial_) steady.b_g = end.b_g - gyro_at(to);
  return steady;
}

void Motion::path(const State& end, RigTime from, RigTime to, SweepPath& path) noexcept {
  if (inertial_ && imu_covers(from, to)) return path.set(end, to - from, imu_.spans(from, to));
  path.set(steady(end, to), to - from);
}

PathKnot Motion::knot(const State& end, RigTime at, RigTime to) noexcept {
  const double before_end_s = (to - at).seconds();
  if (inertial_ && imu_covers(at, to)) return SweepPath::knot(end, before_end_s, imu_.spans(at, to));
  return SweepPath::knot(steady(end, to), before_end_s);
}

Vector6d Motion::path_variance(RigTime at, RigTime to) const noexcept {
  const double span_s = (to - at).seconds();
  const bool measured = inertial_ && imu_covers(at, to);
  return (measured ? process_noise(*setup_.imu, span_s) : process_noise(noise_, span_s)).diagonal().head<6>();
}

std::optional<Eigen::Matrix3d> Motion::turn(const State& x, RigTime then, RigTime now) noexcept {
  if (!inertial_ || !imu_covers(then, now)) return std::nullopt;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (const InertialSpan& span : imu_.spans(then, now)) R = R * Exp((span.rate_radps - x.b_g) * span.span_s);
  return R;
}

}  // namespace lxd
