// SPDX-License-Identifier: Apache-2.0
#include "estimator/sweep_path.hpp"

namespace lxd {
namespace {

constexpr double kMeanTime = 1.0 / 2, kLateTime = 1.0 / 3;  // of a span, before its end: as inertial_propagation.cpp

// What the readings between a time tau and the sweep's end add up to; `at` a reading's end, or within it.
struct Backwards {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();       // Gamma
  Eigen::Matrix3d turn_by_bias = Eigen::Matrix3d::Zero();   // G
  Eigen::Vector3d speed = Eigen::Vector3d::Zero();          // once integrated force, in the body at the end
  Eigen::Matrix3d speed_by_bias = Eigen::Matrix3d::Zero();  // by b_g
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();          // beta: twice integrated
  Eigen::Matrix3d lever_by_bias = Eigen::Matrix3d::Zero();  // by b_g
  double before_end_s = 0;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  // then, in the body then
};

struct Force {
  Eigen::Vector3d value;    // in the body at the sweep's end
  Eigen::Matrix3d by_bias;  // d value / d b_g
};

// The unbiased force, turned with the body as it was t before the reading's end.
Force force_before(const Backwards& at, const Eigen::Vector3d& rate, const Eigen::Vector3d& force, double t) {
  const Eigen::Vector3d value = at.turn * (Exp(-rate * t) * force);
  return {value, -hat(value) * (at.turn_by_bias + at.turn * Jr(rate * t) * t)};
}

// s further back within a reading whose end is `at`.
Backwards back(const Backwards& at, const State& end, const InertialSpan& reading, double s) {
  const Eigen::Vector3d rate = reading.rate_radps - end.b_g, force = reading.force_mps2 - end.b_a;
  const Force mean = force_before(at, rate, force, kMeanTime * s), late = force_before(at, rate, force, kLateTime * s);
  Backwards out;
  out.turn = at.turn * Exp(-rate * s);
  out.turn_by_bias = at.turn_by_bias + at.turn * Jr(rate * s) * s;
  out.speed = at.speed + mean.value * s;
  out.speed_by_bias = at.speed_by_bias + mean.by_bias * s;
  out.lever = at.lever + at.speed * s + late.value * (s * s / 2);
  out.lever_by_bias = at.lever_by_bias + at.speed_by_bias * s + late.by_bias * (s * s / 2);
  out.before_end_s = at.before_end_s + s;
  const double part = reading.span_s > 0 ? s / reading.span_s : 0;
  out.rate = rate + (1.0 / 2 - part) * reading.rate_change_radps;
  return out;
}

// Late readings turn the body between then and the end as it turned between a little before each.
PathKnot knot_of(const State& end, const Backwards& b, const Eigen::Vector3d& rate_at_end) {
  const double tau = b.before_end_s;
  return {end.R * b.turn,
          end.p - end.v * tau + end.g * (tau * tau / 2) + end.R * b.lever,
          b.turn,
          b.turn_by_bias,
          b.lever,
          b.lever_by_bias,
          tau,
          b.turn * b.rate - rate_at_end};
}

// Walks back along the readings; each call asks for a time no later than the last one's.
class WalkBack {
 public:
  WalkBack(const State& end, std::span<const InertialSpan> measured)
      : end_(end), measured_(measured), rate_at_end_(to(0).rate) {}

  PathKnot knot(double before_end_s) { return knot_of(end_, to(before_end_s), rate_at_end_); }

 private:
  Backwards to(double before_end_s) {
    while (!measured_.empty() && before_end_s > at_.before_end_s + measured_.back().span_s) {
      at_ = back(at_, end_, measured_.back(), measured_.back().span_s);
      last_ = measured_.back();
      measured_ = measured_.first(measured_.size() - 1);
    }
    const InertialSpan& reading = measured_.empty() ? last_ : measured_.back();
    return back(at_, end_, reading, before_end_s - at_.before_end_s);
  }

  const State& end_;
  std::span<const InertialSpan> measured_;
  InertialSpan last_{0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // held where rounding asks for more
  Backwards at_;
  Eigen::Vector3d rate_at_end_;
};

}  // namespace

LidarVector row_along(const PathKnot& knot, const Eigen::Vector3d& q_body, const Eigen::Vector3d& n_world) {
  const Eigen::Vector3d h = knot.turn * (knot.R.transpose() * n_world);
  const Eigen::Vector3d about_then = (knot.turn * q_body).cross(h);
  LidarVector row;
  row.segment<3>(kTheta) = about_then + knot.lever.cross(h);
  row.segment<3>(kPosition) = n_world;
  row.segment<3>(kVelocity) = -knot.before_end_s * n_world;
  row.segment<3>(kGyroBias) = knot.turn_by_bias.transpose() * about_then + knot.lever_by_bias.transpose() * h;
  return row;
}

double row_by_delay(const PathKnot& knot, const Eigen::Vector3d& q_body, const Eigen::Vector3d& n_world) {
  const Eigen::Vector3d h = knot.turn * (knot.R.transpose() * n_world);
  return (knot.turn * q_body).cross(h).dot(knot.turn_by_delay);
}

LidarMatrix motion_of(const PathKnot& knot, const Eigen::Vector3d& q_body) {
  LidarMatrix rows;  // three of them are used
  for (int axis = 0; axis < 3; ++axis) rows.row(axis) = row_along(knot, q_body, Eigen::Vector3d::Unit(axis));
  return rows.topRows<3>().transpose() * rows.topRows<3>();
}

void SweepPath::begin(const State& end, Duration span) {
  end_ = end;
  span_ = span;
  intervals_per_ns_ = span.ns() > 0 ? static_cast<float>(kIntervals / static_cast<double>(span.ns())) : 0.0f;
}

void SweepPath::place(int i, const PathKnot& knot) {
  knots_[i] = knot;
  float_knots_[i] = {knot.R.cast<float>(), (knot.p - end_.p).cast<float>()};
}

void SweepPath::set(const State& end, Duration span) {
  begin(end, span);
  for (int i = 0; i <= kIntervals; ++i) place(i, knot(end, before_end_s(i)));
}

void SweepPath::set(const State& end, Duration span, std::span<const InertialSpan> measured) {
  begin(end, span);
  WalkBack walk(end_, measured);
  for (int i = kIntervals; i >= 0; --i) place(i, walk.knot(before_end_s(i)));
}

PathKnot SweepPath::knot(const State& end, double before_end_s) {
  PathKnot k;
  const Eigen::Vector3d psi = end.b_g * before_end_s;
  k.turn = Exp(psi);
  k.R = end.R * k.turn;
  k.p = end.p - end.v * before_end_s;
  k.turn_by_bias = before_end_s * Jr(-psi);
  k.before_end_s = before_end_s;
  return k;
}

PathKnot SweepPath::knot(const State& end, double before_end_s, std::span<const InertialSpan> measured) {
  return WalkBack(end, measured).knot(before_end_s);
}

}  // namespace lxd
