// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/camera_alignment.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "estimator/normal_equations.hpp"

namespace lxd {
namespace {

// A camera's clock is set by a host or a trigger: 0.15 ms in a minute, as the IMU's.
constexpr double kDelayWalk_s_per_sqrt_s = 2e-5;
constexpr double kMountWalk_rad_per_sqrt_s = 2e-5;  // warmth and load: 0.01 degrees in a minute
constexpr double kDelayMax_s = 0.05;                // sensors that are farther apart than this are no rig
constexpr double kTurnedMax_rad = 0.17;             // ten degrees: beyond, features and surfaces were never matched
constexpr double kRateChangeMin_radps = 0.05;       // between two images: less is the gyroscope's noise
constexpr double kMountTurnMin_rad = 0.01;          // likewise: of less the errors of both are too large a share
constexpr double kTurnSeen_rad = 0.004;             // likewise, for a mount that is wrong altogether
constexpr double kTurnedMin_rad2 = 0.02;            // sum of squares: eight turns of 0.05 rad
constexpr double kPathSigma_rad = 1e-4;             // of the path's turn, an axis
constexpr double kImagesAlike = 10;                 // so many neighbouring images err alike
constexpr double kUnexplainedGate = 16.3;           // chi-square, three degrees of freedom, 0.999
constexpr double kMisfitShare = 0.05;               // of one turn in the running mean
constexpr double kKernel_sigmas = 3;
constexpr double kBeyondClaim = 4;  // sigmas that a rig file may be off by: what they explain is no misfit

}  // namespace

// With T the path's turn and R* = Exp(e) R the camera's true mount, the images' turn is Exp(-e) T Exp(e).
TurnRow turn_row(const Eigen::Matrix3d& path, const Eigen::Matrix3d& path_earlier, const Eigen::Matrix3d& seen) {
  TurnRow row{Log(path.transpose() * seen), {}};
  row.by.col(0) = Log(path.transpose() * path_earlier) / CameraAlignment::kEarlier.seconds();
  row.by.rightCols<3>() = Eigen::Matrix3d::Identity() - path.transpose();
  return row;
}

CameraAlignment::CameraAlignment(const MountedCamera& camera)
    : delay_s_(camera.delay_s), R_given_(camera.T_body_camera.R), R_body_camera_(camera.T_body_camera.R) {
  P_.diagonal() << camera.delay_sigma_s, Eigen::Vector3d::Constant(camera.rotation_sigma_rad);
  P_ = P_.cwiseAbs2().eval();
}

void CameraAlignment::pass(Duration span) noexcept {
  const double s = std::max(0.0, span.seconds());
  if (delay_open()) P_(0, 0) += kDelayWalk_s_per_sqrt_s * kDelayWalk_s_per_sqrt_s * s;
  if (mount_open()) P_.diagonal().tail<3>().array() += kMountWalk_rad_per_sqrt_s * kMountWalk_rad_per_sqrt_s * s;
}

double CameraAlignment::unlike() const { return turned_rad2_ > kTurnedMin_rad2 ? lacking_rad2_ / turned_rad2_ : 0; }

void CameraAlignment::compare_at_large(const TurnRow& row) {
  const double turned_rad2 = row.by.rightCols<3>().squaredNorm() / 2;  // 2 - 2 cos of the turn
  if (!(turned_rad2 > kTurnSeen_rad * kTurnSeen_rad)) return;
  lacking_rad2_ += row.lacking.squaredNorm();
  turned_rad2_ += turned_rad2;
}

// lacking = by [delay, rotation] + noise. What not even a rig file that is wrong explains tells how far the noise is
// believed.
void CameraAlignment::learn(TurnRow row, const Eigen::Matrix3d& covariance) noexcept {
  if (!row.lacking.allFinite()) return;
  compare_at_large(row);
  if (!(row.by.col(0).norm() > kRateChangeMin_radps)) row.by.col(0).setZero();
  if (!(row.by.rightCols<3>().norm() > kMountTurnMin_rad)) row.by.rightCols<3>().setZero();
  if (!(row.by.squaredNorm() > 0)) return;
  const Eigen::Matrix3d noise = covariance + kPathSigma_rad * kPathSigma_rad * Eigen::Matrix3d::Identity();
  const Eigen::Matrix<double, 4, 3> coupling = P_ * row.by.transpose();
  const Eigen::Matrix3d doubt = row.by * coupling;
  const auto ratio = [&](double beyond) {
    const Eigen::LLT<Eigen::Matrix3d> factors(misfit_ * noise + beyond * beyond * doubt);
    return factors.info() == Eigen::Success ? row.lacking.dot(factors.solve(row.lacking)) : NAN;
  };
  const double rest = ratio(kBeyondClaim), explained = ratio(1) - rest;
  if (!std::isfinite(explained)) return;
  const double weight = geman_mcclure(explained, kKernel_sigmas * kKernel_sigmas) / (kImagesAlike * misfit_);
  misfit_ = std::max(1.0, misfit_ * (1 + kMisfitShare * (std::min(rest / 3, kUnexplainedGate) - 1)));
  if (!(rest < kUnexplainedGate)) return;
  const Eigen::LLT<Eigen::Matrix3d> innovation(doubt + noise / weight);
  if (innovation.info() != Eigen::Success) return;
  correct(coupling * innovation.solve(row.lacking));
  P_ -= coupling * innovation.solve(coupling.transpose());
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

// What would leave the bounds stays where it is.
void CameraAlignment::correct(const Eigen::Vector4d& by) {
  delay_s_ = std::clamp(delay_s_ + by[0], -kDelayMax_s, kDelayMax_s);
  if (!mount_open()) return;
  const Eigen::Matrix3d R = orthonormalized(Exp(by.tail<3>()) * R_body_camera_);
  if (Log(R * R_given_.transpose()).norm() < kTurnedMax_rad) R_body_camera_ = R;
}

void CameraAlignment::follow(RigTime end, const Eigen::Matrix3d& R_world_body, const ImageTurn* seen) noexcept {
  attitudes_.add(end, R_world_body);
  if (seen != nullptr && waiting_count_ < kWaiting) waiting_[waiting_count_++] = *seen;
  while (waiting_count_ > 0 && attitudes_.knows(waiting_[0].now - delay())) {
    compare(waiting_[0], [this](RigTime then, RigTime now) { return attitudes_.turn(then, now); });
    std::copy(waiting_.begin() + 1, waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_count_), waiting_.begin());
    --waiting_count_;
  }
}

}  // namespace lxd
