// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/noise_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr std::size_t kFixesMin = 8;
constexpr std::array kDrifts{0.015, 0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0, 4.0};
constexpr std::array kCorrelations_s{0.1, 0.5, 2.5, 10.0, 30.0, 100.0};
constexpr std::array kJitters_s{0.0005, 0.002, 0.008, 0.03};
constexpr std::array kWhiteShares{0.3, 0.1, 0.03, 0.01, 0.003};
// The white share shows in fixes that follow each other, the rest in some of a long time.
constexpr std::size_t kSuccessiveMax = 256, kFixesMax = 2048;
constexpr std::array kDriftsBeside{0.0, 0.25, 2.0};  // that the white share is sought beside
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
std::vector<Sight<Axes>> sights_of(std::span<const Step> steps, double white_share) {
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
    sight.lasting_root = ((1 - white_share) * C).llt().matrixL();
    sight.white_m2 = white_share * C;
    sight.velocity_mps = step.velocity_mps(Axes::kAlong);
    sights.push_back(sight);
  }
  return sights;
}

struct Levels {
  double drift, correlation_s, jitter_s;
};

// By how much odometry's antenna is off, its rotation, what lasts of the fix's error in units of its own sigmas, and by
// how much fixes are older than they are taken for.
template <class Axes>
class Filter {
 public:
  static constexpr int kP = Sight<Axes>::kP, kR = Sight<Axes>::kR, kLasting = kP + kR, kDelay = kLasting + kP,
                       kN = kDelay + 1;

  Filter(const Sight<Axes>& first, const Levels& levels, double delay_sigma_s) : levels_(levels) {
    x_.template head<kP>() = first.misfit_m;
    P_.diagonal().template head<kP>().setConstant(kOpenPosition_m * kOpenPosition_m);
    P_.diagonal().template segment<kR>(kP).setConstant(kOpenRotation_rad * kOpenRotation_rad);
    P_.diagonal().template segment<kP>(kLasting).setOnes();
    P_(kDelay, kDelay) = delay_sigma_s * delay_sigma_s;
  }

  void drive_on(const Sight<Axes>& sight) {
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
  double see(const Sight<Axes>& sight) {
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
  using State = Eigen::Matrix<double, kN, kN>;
  Levels levels_;
  Eigen::Matrix<double, kN, 1> x_ = Eigen::Matrix<double, kN, 1>::Zero();
  State P_ = State::Zero();
};

template <class Axes>
double log_likelihood(std::span<const Sight<Axes>> sights, const Levels& levels, double delay_sigma_s) {
  double sum = 0;
  Filter<Axes> filter(sights.front(), levels, delay_sigma_s);
  for (const Sight<Axes>& sight : sights) {
    filter.drive_on(sight);
    sum += filter.see(sight);
  }
  return sum;
}

// How the fixes may err: each time constant with each jitter.
constexpr int kNoises = static_cast<int>(kCorrelations_s.size() * kJitters_s.size());
using ByNoise = Eigen::Array<double, 1, kNoises>;
using ByDrift = Eigen::Array<double, static_cast<int>(kDrifts.size()), 1>;

double correlation_of(int noise) { return kCorrelations_s[static_cast<std::size_t>(noise) / kJitters_s.size()]; }
double jitter_of(int noise) { return kJitters_s[static_cast<std::size_t>(noise) % kJitters_s.size()]; }

// The logarithm of how likely the fixes are.
struct Likelihoods {
  Eigen::Array<double, ByDrift::RowsAtCompileTime, kNoises> drifting;  // where odometry drifts so far
  ByNoise still;                                                       // where it does not
};

template <class Axes>
Likelihoods likelihoods(std::span<const Step> steps, double white_share, double delay_sigma_s) {
  const std::vector<Sight<Axes>> sights = sights_of<Axes>(steps, white_share);
  Likelihoods found;
  for (int noise = 0; noise < kNoises; ++noise) {
    const auto given = [&](double drift) {
      return log_likelihood<Axes>(sights, {drift, correlation_of(noise), jitter_of(noise)}, delay_sigma_s);
    };
    for (int i = 0; i < found.drifting.rows(); ++i)
      found.drifting(i, noise) = given(kDrifts[static_cast<std::size_t>(i)]);
    found.still[noise] = given(0);
  }
  return found;
}

// The logarithm of a sum of what is given by its logarithms.
template <class Logarithms>
double log_sum(const Logarithms& logarithms) {
  const double largest = logarithms.maxCoeff();
  return largest + std::log((logarithms - largest).exp().sum());
}

ByDrift logarithms_of_drifts() { return Eigen::Map<const ByDrift>(kDrifts.data()).log(); }

// Of the drifts, before any fix has come.
ByDrift log_priors() {
  const ByDrift off = (logarithms_of_drifts() - std::log(kDriftExpected)) / std::log(kDriftSpread);
  const ByDrift priors = -0.5 * off.square();
  return priors - log_sum(priors);
}

// How likely each noise is where odometry drifts, and the drift's mean on a logarithmic scale given that noise.
struct Drifting {
  ByNoise log_likelihood, log_drift;
};

Drifting drifting(const Likelihoods& found) {
  Drifting by;
  for (int noise = 0; noise < kNoises; ++noise) {
    const ByDrift joint = found.drifting.col(noise) + log_priors();
    by.log_likelihood[noise] = log_sum(joint);
    by.log_drift[noise] = ((joint - by.log_likelihood[noise]).exp() * logarithms_of_drifts()).sum();
  }
  return by;
}

// The logarithm of how likely the fixes are where so much of their variance is white, and the rest as suits it best.
template <class Axes>
double best_with(std::span<const Step> steps, double white_share, double delay_sigma_s) {
  const std::vector<Sight<Axes>> sights = sights_of<Axes>(steps, white_share);
  double best = -std::numeric_limits<double>::infinity();
  for (const double correlation_s : kCorrelations_s)
    for (const double drift : kDriftsBeside)
      best = std::max(best, log_likelihood<Axes>(sights, {drift, correlation_s, kJitters_s.front()}, delay_sigma_s));
  return best;
}

double find_white_share(std::span<const Step> steps, double delay_sigma_s) {
  std::array<double, kWhiteShares.size()> found{};
  std::ranges::transform(kWhiteShares, found.begin(), [&](double share) {
    return best_with<Horizontal>(steps, share, delay_sigma_s) + best_with<Vertical>(steps, share, delay_sigma_s);
  });
  return kWhiteShares[static_cast<std::size_t>(std::ranges::max_element(found) - found.begin())];
}

std::vector<GnssMeasurement> thinned(std::span<const GnssMeasurement> fixes) {
  const std::size_t stride = (fixes.size() + kFixesMax - 1) / kFixesMax;
  std::vector<GnssMeasurement> some;
  for (std::size_t i = 0; i < fixes.size(); i += stride) some.push_back(fixes[i]);
  return some;
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

// Means on a logarithmic scale, over what the fixes make likely. Heights have noise of their own in the odds: where a
// receiver claims too much or too little of them, that is no drift of level positions.
std::optional<NoiseLevels> find_noise_levels(const OdometryChain& chain, std::span<const GnssMeasurement> fixes,
                                             const Pose& T_enu_world, double delay_s, double delay_sigma_s) {
  if (fixes.size() < kFixesMin) return std::nullopt;
  const auto latest = fixes.last(std::min(fixes.size(), kSuccessiveMax));
  const double white_share = find_white_share(steps_of(chain, latest, T_enu_world, delay_s), delay_sigma_s);
  const std::vector<Step> steps = steps_of(chain, thinned(fixes), T_enu_world, delay_s);
  const Likelihoods horizontal = likelihoods<Horizontal>(steps, white_share, delay_sigma_s);
  const Likelihoods vertical = likelihoods<Vertical>(steps, white_share, delay_sigma_s);
  const Drifting h = drifting(horizontal), v = drifting(vertical);
  const double log_odds =
      log_sum(h.log_likelihood) - log_sum(horizontal.still) + log_sum(v.log_likelihood) - log_sum(vertical.still);
  if (!std::isfinite(log_odds)) return std::nullopt;  // the fixes are beyond numbers
  const ByNoise weights = (h.log_likelihood - log_sum(h.log_likelihood)).exp();
  double log_correlation = 0, log_jitter = 0;
  for (int noise = 0; noise < kNoises; ++noise) {
    log_correlation += weights[noise] * std::log(correlation_of(noise));
    log_jitter += weights[noise] * std::log(jitter_of(noise));
  }
  return NoiseLevels{.drift_horizontal = std::exp((weights * h.log_drift).sum()),
                     .drift_vertical = std::exp((weights * v.log_drift).sum()),
                     .white_share = white_share,
                     .correlation_s = std::exp(log_correlation),
                     .jitter_s = std::exp(log_jitter),
                     .log_odds_of_drift = log_odds};
}

}  // namespace lxd
