// SPDX-License-Identifier: Apache-2.0
#include "estimator/rotation_guess.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace lxd {
namespace {

constexpr int kYawStepsMin = 16, kYawStepsMax = RangeImage::kColumns / 2;  // of a column each, to either side
constexpr double kYawSigmas = 3;
constexpr float kYawTolerance = 0.2f;  // relative error of a range that still speaks for a shift
constexpr int kIterations = 8;
constexpr float kFirstKernel = 0.5f, kKernelShrink = 0.6f;  // Geman-McClure kernel, relative error of a range
constexpr float kKernelSigmas = 2.5f, kKernelMin = 0.03f;
constexpr float kMedianToSigma = 1.4826f;  // of a normal distribution
constexpr float kErrorMin = 0.005f;        // the image is not better than that
constexpr float kTurnNone_rad = 1e-6f;
constexpr float kFlatMin_m = 1e-3f;  // a point on the axis has no azimuth
constexpr double kIncrementDone_rad = 2e-4;

// What is asked of a guess that may be used.
constexpr std::size_t kSamplesMin = 100;
constexpr double kInlierShareMin = 0.25;  // of all samples, within kInlierError
constexpr double kSeenShareMin = 0.5;     // of those that meet the previous image
constexpr float kInlierError = 0.15f;
constexpr double kSigmaMax_rad = 0.01;
constexpr double kSensitivityMin = 0.05;  // root mean square change of relative range by rotation: less is noise
constexpr double kFitMax_rad = 1.0;       // the fit may turn by so much beyond the yaw that was sought

int yaw_steps(double yaw_sigma_rad) {
  const double steps = std::ceil(kYawSigmas * yaw_sigma_rad / static_cast<double>(RangeImage::kStep_rad));
  return static_cast<int>(std::clamp<double>(steps, kYawStepsMin, kYawStepsMax));
}

// Exp(theta) p.
Eigen::Vector3f turned(const Eigen::Vector3f& theta, const Eigen::Vector3f& p) {
  const float angle = theta.norm();
  if (angle < kTurnNone_rad) return p;
  const Eigen::Vector3f axis = theta / angle, across = axis.cross(p);
  return p + std::sin(angle) * across + (1 - std::cos(angle)) * axis.cross(across);
}

}  // namespace

// With h the distance from the z axis, d azimuth = (x dy - y dx) / h^2, d elevation = (h dz - z (x dx + y dy) / h) /
// |x|^2, and dx = elapsed (drotation x x + dtranslation).
bool range_error(const RangeImage& previous, const Eigen::Vector3f& x, float elapsed, float& error,
                 RangeErrorRow& row) {
  const Spherical s = to_spherical(x);
  RangeImage::Look look;
  if (!previous.look(s.azimuth_rad, s.elevation_rad, look)) return false;
  const float h = std::max(x.head<2>().norm(), kFlatMin_m);
  error = s.range_m * look.inverse_range - 1;
  const Eigen::Vector3f azimuth(-x.y() / (h * h), x.x() / (h * h), 0);
  const Eigen::Vector3f elevation =
      Eigen::Vector3f(-x.z() * x.x() / h, -x.z() * x.y() / h, h) / (s.range_m * s.range_m);
  const Eigen::Vector3f slope = elapsed * (s.range_m * (look.d_azimuth * azimuth + look.d_elevation * elevation) +
                                           look.inverse_range / s.range_m * x);
  row.head<3>() = x.cross(slope);
  row.tail<3>() = slope;
  return true;
}

RotationGuess::RotationGuess(Arena& arena)
    : previous_(arena),
      polar_(arena.take<Spherical>("rotation guess samples", kSamplesMax)),
      errors_(arena.take<float>("rotation guess errors", kSamplesMax)) {}

// A turn about the LiDAR's own axis shifts columns and does nothing else.
double RotationGuess::seek_yaw(std::span<const GuessSample> samples, int columns) const {
  std::array<float, 2 * kYawStepsMax + 1> score{};
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (int k = -columns; k <= columns; ++k) {
      RangeImage::Look look;
      const float yaw = static_cast<float>(k) * RangeImage::kStep_rad * samples[i].elapsed;
      if (!previous_.look(polar_[i].azimuth_rad + yaw, polar_[i].elevation_rad, look)) continue;
      const float ratio = (polar_[i].range_m * look.inverse_range - 1) / kYawTolerance;
      score[static_cast<std::size_t>(k + columns)] += 1 / (1 + ratio * ratio);
    }
  const auto best = std::max_element(score.begin(), score.begin() + 2 * columns + 1) - score.begin();
  return static_cast<double>(best - columns) * static_cast<double>(RangeImage::kStep_rad);
}

RotationGuess::Fit RotationGuess::measure(std::span<const GuessSample> samples, const Eigen::Vector3d& rotation,
                                          const Eigen::Vector3d& translation, float kernel) {
  Fit fit;
  const Eigen::Vector3f theta = rotation.cast<float>(), t = translation.cast<float>();
  for (const GuessSample& sample : samples) {
    float error = 0;
    RangeErrorRow row;
    const Eigen::Vector3f x = turned(sample.elapsed * theta, sample.p_m) + sample.elapsed * t;
    if (!range_error(previous_, x, sample.elapsed, error, row)) continue;
    errors_[fit.seen++] = std::abs(error);
    if (std::abs(error) < kInlierError) ++fit.inliers;
    const float q = 1 / (1 + error * error / (kernel * kernel));
    const RangeErrorRow weighted = q * q * row;
    fit.information.noalias() += weighted * row.transpose();
    fit.gradient += error * weighted;
    fit.weight += q * q;
  }
  if (fit.seen == 0) return fit;
  const auto middle = errors_.begin() + static_cast<std::ptrdiff_t>(fit.seen / 2);
  std::nth_element(errors_.begin(), middle, errors_.begin() + static_cast<std::ptrdiff_t>(fit.seen));
  fit.scale = std::max(kErrorMin, kMedianToSigma * *middle);
  return fit;
}

// The translation is a nuisance with a prior; the rotation has hardly any.
bool RotationGuess::step(const Fit& fit, double translation_sigma_m, RotationGuessResult& out) {
  const double variance = static_cast<double>(fit.scale) * static_cast<double>(fit.scale);
  const double prior = 1.0 / (translation_sigma_m * translation_sigma_m);
  Matrix6 A = fit.information.cast<double>() / variance;
  Vector6 b = fit.gradient.cast<double>() / variance;
  A.topLeftCorner<3, 3>().diagonal().array() += 1.0 / (kFitMax_rad * kFitMax_rad);
  A.bottomRightCorner<3, 3>().diagonal().array() += prior;
  b.tail<3>() += prior * out.translation_m;
  const Vector6 increment = -A.ldlt().solve(b);
  out.rotation_rad += increment.head<3>();
  out.translation_m += increment.tail<3>();
  const Eigen::Matrix3d cross = A.topRightCorner<3, 3>();
  held_ = A.topLeftCorner<3, 3>() - cross * A.bottomRightCorner<3, 3>().ldlt().solve(cross.transpose());
  return increment.head<3>().norm() < kIncrementDone_rad;
}

void RotationGuess::judge(const Fit& fit, std::size_t samples, RotationGuessResult& out) const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(held_);
  const double weakest = axes.eigenvalues()[0];
  out.covariance =
      axes.eigenvectors() * axes.eigenvalues().cwiseInverse().asDiagonal() * axes.eigenvectors().transpose();
  out.inlier_share = static_cast<double>(fit.inliers) / static_cast<double>(samples);
  const double sensitivity = weakest * static_cast<double>(fit.scale * fit.scale) / static_cast<double>(fit.weight);
  out.valid = out.inlier_share >= kInlierShareMin &&
              static_cast<double>(fit.inliers) >= kSeenShareMin * static_cast<double>(fit.seen) &&
              weakest > 1 / (kSigmaMax_rad * kSigmaMax_rad) && sensitivity > kSensitivityMin * kSensitivityMin;
}

RotationGuessResult RotationGuess::seek(std::span<const GuessSample> samples, const Doubt& doubt) noexcept {
  samples = samples.first(std::min(samples.size(), kSamplesMax));
  RotationGuessResult out;
  if (samples.size() < kSamplesMin || previous_.empty()) return out;
  std::transform(samples.begin(), samples.end(), polar_.begin(),
                 [](const GuessSample& s) { return to_spherical(s.p_m); });
  const Eigen::Vector3d sought(0, 0, seek_yaw(samples, yaw_steps(doubt.yaw_sigma_rad)));
  out.rotation_rad = sought;
  float kernel = kFirstKernel;
  for (int i = 0; i < kIterations; ++i) {
    const Fit fit = measure(samples, out.rotation_rad, out.translation_m, kernel);
    if (fit.seen < kSamplesMin || !((out.rotation_rad - sought).norm() < kFitMax_rad)) return {};
    const bool rests = step(fit, doubt.translation_sigma_m, out);
    kernel = std::max({kernel * kKernelShrink, kKernelSigmas * fit.scale, kKernelMin});
    if (rests || i + 1 == kIterations) {
      judge(fit, samples.size(), out);
      break;
    }
  }
  out.valid = out.valid && (out.rotation_rad - sought).norm() < kFitMax_rad;
  return out;
}

}  // namespace lxd
