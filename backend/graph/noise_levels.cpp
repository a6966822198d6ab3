// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/noise_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr std::size_t kFixesMin = 8;
constexpr std::array kDrifts{0.015, 0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0, 4.0};
constexpr std::array kCorrelations_s{0.1, 0.5, 2.5, 10.0, 30.0, 100.0};
constexpr std::array kJitters_s{0.0005, 0.002, 0.008, 0.03};
// Before any fix has come: between a gyroscope beside a good LiDAR, a tenth of what the chain says, and a LiDAR alone
// with a mediocre calibration.
constexpr double kDriftExpected = 0.3, kDriftSpread = 3;
// What is open about the map's place on the earth.
constexpr double kOpenPosition_m = 10, kOpenRotation_rad = 0.1;
// Innovations are Student's t with so many degrees of freedom: one that is far off says little.
constexpr double kFreedom = 10;

// Of the axes east, north, up: those that a position errs along, and those that a rotation errs about, which carries on
// into those positions.
struct Horizontal {
  static constexpr std::array kAlong{0, 1};
  static constexpr std::array kAbout{2};
};
struct Vertical {
  static constexpr std::array kAlong{2};
  static constexpr std::array kAbout{0, 1};
};

// A fix and what odometry says of it, in some of the earth's axes.
template <class Axes>
struct Sight {
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
struct Step {
  Eigen::Vector3d moved_m;  // the antenna
  Matrix6d drift;           // covariance of (rotation, position)
  double since_s;
  Eigen::Vector3d misfit_m;
  Eigen::Matrix3d covariance_m2;  // of the fix
  Eigen::Vector3d velocity_mps;   // of the antenna
};

std::vector<Step> steps_of(const OdometryChain& chain, std::span<const GnssMeasurement> fixes, const Pose& T_enu_world,
                           double delay_s) {
  std::vector<Step> steps;
  Eigen::Vector3d last_m = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const GnssMeasurement &fix = fixes[i], &before = fixes[i > 0 ? i - 1 : 0];
    const int a = static_cast<int>(before.key_frame), b = static_cast<int>(fix.key_frame);
    const Pose T_enu_b = T_enu_world * chain[b].T_world_body;
    const Eigen::Vector3d at_m = T_enu_b * (fix.antenna_body_m - delay_s * fix.antenna_velocity_mps);
    Matrix6d to_enu = Matrix6d::Zero();  // rotations come in axes of b, positions in those of a
    to_enu.topLeftCorner<3, 3>() = T_enu_b.R;
    to_enu.bottomRightCorner<3, 3>() = T_enu_world.R * chain[a].T_world_body.R;
    const Eigen::Vector3d moved_m = i > 0 ? Eigen::Vector3d(at_m - last_m) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    steps.push_back({moved_m, to_enu * chain.motion(a, b).covariance * to_enu.transpose(),
                     (fix.stamp - before.stamp).seconds(), fix.enu_m - at_m, fix.covariance_m2,
                     T_enu_b.R * fix.antenna_velocity_mps});
    last_m = at_m;
  }
  return steps;
}

template <class Axes>
std::vector<Sight<Axes>> sights_of(std::span<const Step> steps) {
  constexpr int P = Sight<Axes>::kP, R = Sight<Axes>::kR;
  std::array<int, P + R> rows;  // of (rotation, position)
  for (int k = 0; k < P; ++k) rows[static_cast<std::size_t>(k)] = 3 + Axes::kAlong[static_cast<std::size_t>(k)];
  std::ranges::copy(Axes::kAbout, rows.begin() + P);
  std::vector<Sight<Axes>> sights;
  for (const Step& step : steps) {
    const Eigen::Matrix<double, P, P> C = step.covariance_m2(Axes::kAlong, Axes::kAlong);
    Sight<Axes> sight;
    sight.lever_m = -hat(step.moved_m)(Axes::kAlong, Axes::kAbout);
    sight.drift = step.drift(rows, rows);
    sight.since_s = step.since_s;
    sight.misfit_m = step.misfit_m(Axes::kAlong);
    sight.lasting_root = (kLastingShare * C).llt().matrixL();
    sight.white_m2 = (1 - kLastingShare) * C;
    sight.velocity_mps = step.velocity_mps(Axes::kAlong);
    sights.push_back(sight);
  }
  return sights;
}

struct Levels {
  double drift, correlation_s, jitter_s;
};

// By how much odometry's antenna is off, its rotation, and what lasts of the fix's error in units of its own sigmas.
template <class Axes>
class Filter {
 public:
  static constexpr int kP = Sight<Axes>::kP, kR = Sight<Axes>::kR, kN = kP + kR + kP;

  Filter(const Sight<Axes>& first, const Levels& levels) : levels_(levels) {
    x_.template head<kP>() = first.misfit_m;
    P_.diagonal().template head<kP>().setConstant(kOpenPosition_m * kOpenPosition_m);
    P_.diagonal().template segment<kR>(kP).setConstant(kOpenRotation_rad * kOpenRotation_rad);
    P_.diagonal().template tail<kP>().setOnes();
  }

  void drive_on(const Sight<Axes>& sight) {
    const double keep = std::exp(-sight.since_s / levels_.correlation_s);
    State F = State::Identity();
    F.template block<kP, kR>(0, kP) = sight.lever_m;
    F.diagonal().template tail<kP>().setConstant(keep);
    x_ = F * x_;
    P_ = F * P_ * F.transpose();
    P_.template topLeftCorner<kP + kR, kP + kR>() += levels_.drift * levels_.drift * sight.drift;
    P_.diagonal().template tail<kP>().array() += 1 - keep * keep;
  }

  // The logarithm of how likely the fix was.
  double see(const Sight<Axes>& sight) {
    Eigen::Matrix<double, kP, kN> H = Eigen::Matrix<double, kP, kN>::Zero();
    H.template leftCols<kP>().setIdentity();
    H.template rightCols<kP>() = sight.lasting_root;
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
  using State = Eigen::Matrix<double, kN, kN>;
  Levels levels_;
  Eigen::Matrix<double, kN, 1> x_ = Eigen::Matrix<double, kN, 1>::Zero();
  State P_ = State::Zero();
};

template <class Axes>
double log_likelihood(std::span<const Sight<Axes>> sights, const Levels& levels) {
  const double off = std::log(levels.drift / kDriftExpected) / std::log(kDriftSpread);
  double sum = -0.5 * off * off;
  Filter<Axes> filter(sights.front(), levels);
  for (const Sight<Axes>& sight : sights) {
    filter.drive_on(sight);
    sum += filter.see(sight);
  }
  return sum;
}

// The mean, on a logarithmic scale, over what the fixes make likely. None: they are beyond numbers.
template <class Axes>
std::optional<Levels> likely_levels(std::span<const Step> steps, std::span<const double> correlations_s,
                                    std::span<const double> jitters_s) {
  const std::vector<Sight<Axes>> sights = sights_of<Axes>(steps);
  std::vector<std::pair<double, Eigen::Array3d>> candidates;
  for (const double drift : kDrifts)
    for (const double correlation_s : correlations_s)
      for (const double jitter_s : jitters_s)
        candidates.emplace_back(log_likelihood<Axes>(sights, {drift, correlation_s, jitter_s}),
                                Eigen::Array3d(drift, correlation_s, jitter_s).log());
  const double best = std::ranges::max(candidates, {}, [](const auto& c) { return c.first; }).first;
  double weights = 0;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (const auto& [likelihood, logarithms] : candidates) {
    const double weight = std::exp(likelihood - best);
    weights += weight;
    sum += weight * logarithms;
  }
  if (!std::isfinite(weights)) return std::nullopt;
  const Eigen::Array3d mean = (sum / weights).exp();
  return Levels{mean[0], mean[1], mean[2]};
}

}  // namespace

Matrix6d scaled(const RelativeMotion& motion, const Eigen::Matrix3d& R_map_a, const NoiseLevels& levels) {
  const double h = levels.drift_horizontal, v = levels.drift_vertical;
  const Eigen::Matrix3d R_map_b = R_map_a * motion.T.R;
  Matrix6d M = Matrix6d::Zero();
  M.topLeftCorner<3, 3>() = R_map_b.transpose() * Eigen::Vector3d(v, v, h).asDiagonal() * R_map_b;
  M.bottomRightCorner<3, 3>() = R_map_a.transpose() * Eigen::Vector3d(h, h, v).asDiagonal() * R_map_a;
  return M * motion.covariance * M.transpose();
}

std::optional<NoiseLevels> find_noise_levels(const OdometryChain& chain, std::span<const GnssMeasurement> fixes,
                                             const Pose& T_enu_world, double delay_s) {
  if (fixes.size() < kFixesMin) return std::nullopt;
  const std::vector<Step> steps = steps_of(chain, fixes, T_enu_world, delay_s);
  const auto horizontal = likely_levels<Horizontal>(steps, kCorrelations_s, kJitters_s);
  if (!horizontal) return std::nullopt;
  const auto vertical = likely_levels<Vertical>(steps, {&horizontal->correlation_s, 1}, {&horizontal->jitter_s, 1});
  if (!vertical) return std::nullopt;
  return NoiseLevels{horizontal->drift, vertical->drift, horizontal->correlation_s, horizontal->jitter_s};
}

}  // namespace lxd
