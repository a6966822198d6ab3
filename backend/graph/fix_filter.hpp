// SPDX-License-Identifier: Apache-2.0
// A filter over the path that knows how far odometry drifts and how fixes err, and says how likely the fixes are if
// that is so. Level positions with yaw, and heights with tilt, have their own.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Cholesky>

#include "backend/graph/gnss_fix.hpp"
#include "backend/graph/odometry_chain.hpp"
#include "rt/so3.hpp"

namespace lxd {

// Of the axes east, north, up: those that a position errs along, and those that a rotation errs about, which carries on
// into those positions.
struct LevelAxes {
  static constexpr std::array kAlong{0, 1};
  static constexpr std::array kAbout{2};
};
struct UpAxes {
  static constexpr std::array kAlong{2};
  static constexpr std::array kAbout{0, 1};
};

// A fix and what odometry says of it, in some of the earth's axes.
template <class Axes>
struct FixSight {
  static constexpr int kP = static_cast<int>(Axes::kAlong.size()), kR = static_cast<int>(Axes::kAbout.size());
  Eigen::Matrix<double, kP, kR> lever_m;          // the way since the last fix, as a rotation carries on over it
  Eigen::Matrix<double, kP + kR, kP + kR> drift;  // covariance since the last fix as the chain says it
  double since_s;                                 // the last fix
  Eigen::Matrix<double, kP, 1> misfit_m;          // the fix less where odometry has the antenna
  Eigen::Matrix<double, kP, kP> lasting_root;     // L of the covariance's lasting share L L^T
  Eigen::Matrix<double, kP, kP> white_m2;         // the rest of it
  Eigen::Matrix<double, kP, 1> velocity_mps;      // of the antenna
};

// A fix and the one before it, by odometry, in all axes of the earth.
struct FixStep {
  Eigen::Vector3d moved_m;  // the antenna
  Matrix6d drift;           // covariance of (rotation, position)
  double since_s;
  Eigen::Vector3d misfit_m;
  Eigen::Matrix3d covariance_m2;  // of the fix
  Eigen::Vector3d velocity_mps;   // of the antenna
};

// One a fix: `T_enu_world` to within a few degrees, fixes late by delay_s.
std::vector<FixStep> steps_of(const OdometryChain& chain, std::span<const GnssMeasurement> fixes,
                              const Pose& T_enu_world, double delay_s);

template <class Axes>
std::vector<FixSight<Axes>> sights_of(std::span<const FixStep> steps, double white_share) {
  constexpr int P = FixSight<Axes>::kP, R = FixSight<Axes>::kR;
  std::array<int, P + R> rows;  // of (rotation, position)
  for (int k = 0; k < P; ++k) rows[static_cast<std::size_t>(k)] = 3 + Axes::kAlong[static_cast<std::size_t>(k)];
  std::ranges::copy(Axes::kAbout, rows.begin() + P);
  std::vector<FixSight<Axes>> sights;
  for (const FixStep& step : steps) {
    const Eigen::Matrix<double, P, P> C = step.covariance_m2(Axes::kAlong, Axes::kAlong);
    FixSight<Axes> sight;
    sight.lever_m = -hat(step.moved_m)(Axes::kAlong, Axes::kAbout);
    sight.drift = step.drift(rows, rows);
    sight.since_s = step.since_s;
    sight.misfit_m = step.misfit_m(Axes::kAlong);
    sight.lasting_root = ((1 - white_share) * C).llt().matrixL();
    sight.white_m2 = white_share * C;
    sight.velocity_mps = step.velocity_mps(Axes::kAlong);
    sights.push_back(sight);
  }
  return sights;
}

struct FixLevels {
  double drift, correlation_s, jitter_s;
};

// By how much odometry's antenna is off, its rotation, what lasts of the fix's error in units of its own sigmas, and by
// how much fixes are older than they are taken for.
template <class Axes>
class FixFilter {
 public:
  static constexpr int kP = FixSight<Axes>::kP, kR = FixSight<Axes>::kR, kLasting = kP + kR, kDelay = kLasting + kP,
                       kN = kDelay + 1;

  FixFilter(const FixSight<Axes>& first, const FixLevels& levels, double delay_sigma_s) : levels_(levels) {
    x_.template head<kP>() = first.misfit_m;
    P_.diagonal().template head<kP>().setConstant(kOpenPosition_m * kOpenPosition_m);
    P_.diagonal().template segment<kR>(kP).setConstant(kOpenRotation_rad * kOpenRotation_rad);
    P_.diagonal().template segment<kP>(kLasting).setOnes();
    P_(kDelay, kDelay) = delay_sigma_s * delay_sigma_s;
  }

  void drive_on(const FixSight<Axes>& sight) {
    const double keep = std::exp(-sight.since_s / levels_.correlation_s);
    State F = State::Identity();
    F.template block<kP, kR>(0, kP) = sight.lever_m;
    F.diagonal().template segment<kP>(kLasting).setConstant(keep);
    x_ = F * x_;
    P_ = F * P_ * F.transpose();
    P_.template topLeftCorner<kP + kR, kP + kR>() += levels_.drift * levels_.drift * sight.drift;
    P_.diagonal().template segment<kP>(kLasting).array() += 1 - keep * keep;
  }

  // The logarithm of how likely the fix was.
  double see(const FixSight<Axes>& sight) {
    Eigen::Matrix<double, kP, kN> H = Eigen::Matrix<double, kP, kN>::Zero();
    H.template leftCols<kP>().setIdentity();
    H.template middleCols<kP>(kLasting) = sight.lasting_root;
    H.col(kDelay) = -sight.velocity_mps;
    const Eigen::Matrix<double, kP, 1> shaken_m = levels_.jitter_s * sight.velocity_mps;
    const Eigen::Matrix<double, kP, kP> white_m2 = sight.white_m2 + shaken_m * shaken_m.transpose();
    const Eigen::Matrix<double, kP, kP> S = H * P_ * H.transpose() + white_m2, S_inverse = S.inverse();
    const Eigen::Matrix<double, kP, 1> innovation = sight.misfit_m - H * x_;
    const double square = innovation.dot(S_inverse * innovation);
    const double weight = std::min(1.0, (kFreedom + kP) / (kFreedom + square));
    const Eigen::Matrix<double, kN, kP> K = weight * P_ * H.transpose() * S_inverse;
    x_ += K * innovation;
    P_ -= K * H * P_;
    P_ = (0.5 * (P_ + P_.transpose())).eval();
    return -0.5 * (kFreedom + kP) * std::log1p(square / kFreedom) - 0.5 * std::log(S.determinant());
  }

 private:
  // What is open about the map's place on the earth.
  static constexpr double kOpenPosition_m = 10, kOpenRotation_rad = 0.1;
  // Innovations are Student's t with so many degrees of freedom: one that is far off says little.
  static constexpr double kFreedom = 10;
  using State = Eigen::Matrix<double, kN, kN>;
  FixLevels levels_;
  Eigen::Matrix<double, kN, 1> x_ = Eigen::Matrix<double, kN, 1>::Zero();
  State P_ = State::Zero();
};

// Of all fixes, the logarithm.
template <class Axes>
double log_likelihood(std::span<const FixSight<Axes>> sights, const FixLevels& levels, double delay_sigma_s) {
  double sum = 0;
  FixFilter<Axes> filter(sights.front(), levels, delay_sigma_s);
  for (const FixSight<Axes>& sight : sights) {
    filter.drive_on(sight);
    sum += filter.see(sight);
  }
  return sum;
}

}  // namespace lxd
