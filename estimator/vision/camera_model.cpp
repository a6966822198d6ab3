// SPDX-License-Identifier: Apache-2.0
// Radial-tangential: Brown's model as OpenCV's calib3d documents it; equidistant: Kannala & Brandt, TPAMI 2006.
#include "estimator/vision/camera_model.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace lxd {
namespace {

constexpr double kWidestRadius = 20;                          // tan 87 degrees: no pinhole sees more
constexpr double kWidestAngle_rad = 0.98 * std::numbers::pi;  // straight behind the camera no direction is left
constexpr double kScanStep = 1e-3;
constexpr double kConverged = 1e-14;  // of the image plane
constexpr double kAccepted = 1e-10;
constexpr int kIterationsMax = 50;
constexpr double kAxisAngle_rad = 1e-6;  // nearer to the axis the pinhole is exact to 1e-12

}  // namespace

CameraModel::CameraModel(const CameraIntrinsics& intrinsics) : intrinsics_(intrinsics) {
  const auto& k = intrinsics.coefficients;
  if (intrinsics.distortion == Distortion::equidistant) radial_ = k;
  if (intrinsics.distortion == Distortion::radtan) {
    radial_ = {k[0], k[1], 0, 0};
    p1_ = k[2];
    p2_ = k[3];
  }
  s_max_ = first_fold(intrinsics.distortion == Distortion::equidistant ? kWidestAngle_rad : kWidestRadius);
}

CameraModel::Bent CameraModel::bent(double s) const {
  const double q = s * s;
  const auto& c = radial_;
  return {s * (1 + q * (c[0] + q * (c[1] + q * (c[2] + q * c[3])))),
          1 + q * (3 * c[0] + q * (5 * c[1] + q * (7 * c[2] + q * 9 * c[3])))};
}

double CameraModel::first_fold(double limit) const {
  double s = 0;
  while (s < limit && bent(s).slope > 0) s += kScanStep;
  return s;
}

// Newton's steps within a bracket that shrinks: the polynomial rises up to s_max.
bool CameraModel::straightened(double wanted, double& s) const {
  double low = 0, high = s_max_;
  if (!(wanted < bent(high).value)) return false;
  s = std::min(wanted, high);
  for (int i = 0; i < kIterationsMax; ++i) {
    const Bent at = bent(s);
    const double error = at.value - wanted;
    if (std::abs(error) < kConverged) return true;
    (error > 0 ? high : low) = s;
    const double next = s - error / at.slope;
    s = next > low && next < high ? next : 0.5 * (low + high);
  }
  return std::abs(bent(s).value - wanted) < kAccepted;
}

Eigen::Vector2d CameraModel::distorted(const Eigen::Vector2d& x, Eigen::Matrix2d& slope) const {
  const double xx = x.x() * x.x(), yy = x.y() * x.y(), xy = x.x() * x.y(), q = xx + yy;
  const double scale = 1 + q * (radial_[0] + q * radial_[1]);
  const double rise = 2 * radial_[0] + 4 * q * radial_[1];  // d scale = rise (x dx + y dy)
  const double mixed = rise * xy + 2 * (p1_ * x.x() + p2_ * x.y());
  slope << scale + rise * xx + 2 * p1_ * x.y() + 6 * p2_ * x.x(), mixed,  //
      mixed, scale + rise * yy + 6 * p1_ * x.y() + 2 * p2_ * x.x();
  return {x.x() * scale + 2 * p1_ * xy + p2_ * (q + 2 * xx), x.y() * scale + p1_ * (q + 2 * yy) + 2 * p2_ * xy};
}

bool CameraModel::image_plane(const Eigen::Vector3d& p, Eigen::Vector2d& m, ProjectionJacobian& J) const {
  if (!(p.z() > 0)) return false;
  const Eigen::Vector2d x = p.head<2>() / p.z();
  if (!(x.squaredNorm() < s_max_ * s_max_)) return false;
  Eigen::Matrix2d slope;
  m = distorted(x, slope);
  J.leftCols<2>() = slope / p.z();
  J.col(2) = -J.leftCols<2>() * x;
  return true;
}

// m = (x, y) d(theta) / r: with s = d / r, dm = s d(x, y) + (x, y) (ds/dr dr + ds/dz dz).
bool CameraModel::image_sphere(const Eigen::Vector3d& p, Eigen::Vector2d& m, ProjectionJacobian& J) const {
  const double r = p.head<2>().norm(), theta = std::atan2(r, p.z());
  if (!(theta < s_max_)) return false;
  if (theta < kAxisAngle_rad) {
    m = p.head<2>() / p.z();
    J << 1 / p.z(), 0, -m.x() / p.z(), 0, 1 / p.z(), -m.y() / p.z();
    return true;
  }
  const Bent d = bent(theta);
  const double s = d.value / r, square = p.squaredNorm();
  const double by_r = (d.slope * p.z() / square - s) / r, by_z = -d.slope / square;
  m = s * p.head<2>();
  J.leftCols<2>() = s * Eigen::Matrix2d::Identity() + (by_r / r) * p.head<2>() * p.head<2>().transpose();
  J.col(2) = by_z * p.head<2>();
  return true;
}

bool CameraModel::project(const Eigen::Vector3d& p_camera_m, Eigen::Vector2d& pixel,
                          ProjectionJacobian* jacobian) const noexcept {
  Eigen::Vector2d m;
  ProjectionJacobian J;
  const bool sphere = intrinsics_.distortion == Distortion::equidistant;
  if (!(sphere ? image_sphere(p_camera_m, m, J) : image_plane(p_camera_m, m, J))) return false;
  pixel = intrinsics_.focal_px.cwiseProduct(m) + intrinsics_.centre_px;
  if (jacobian != nullptr) *jacobian = intrinsics_.focal_px.asDiagonal() * J;
  return pixel.allFinite();
}

// The radial part alone is solved first, which is safe at any radius; what is tangential is small, and Newton's.
bool CameraModel::from_plane(const Eigen::Vector2d& m, Eigen::Vector3d& bearing) const {
  const double radius = m.norm();
  double s = 0;
  if (!straightened(radius, s)) s = s_max_;
  Eigen::Vector2d x = radius > 0 ? Eigen::Vector2d(m * (s / radius)) : m;
  Eigen::Matrix2d slope;
  for (int i = 0; i < kIterationsMax; ++i) {
    const Eigen::Vector2d step = (m - distorted(x, slope));
    x += slope.inverse() * step;
    if (!(step.norm() > kConverged)) break;
  }
  if (!((distorted(x, slope) - m).norm() < kAccepted) || !(x.norm() < s_max_)) return false;
  bearing = Eigen::Vector3d(x.x(), x.y(), 1).normalized();
  return true;
}

bool CameraModel::from_sphere(const Eigen::Vector2d& m, Eigen::Vector3d& bearing) const {
  const double bent_angle = m.norm();
  double angle = 0;
  if (!straightened(bent_angle, angle) || !(angle < s_max_)) return false;
  const Eigen::Vector2d side = bent_angle > 0 ? Eigen::Vector2d(m / bent_angle) : m;
  bearing = {side.x() * std::sin(angle), side.y() * std::sin(angle), std::cos(angle)};
  return true;
}

bool CameraModel::unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& bearing) const noexcept {
  const Eigen::Vector2d m = (pixel - intrinsics_.centre_px).cwiseQuotient(intrinsics_.focal_px);
  if (!m.allFinite()) return false;
  return intrinsics_.distortion == Distortion::equidistant ? from_sphere(m, bearing) : from_plane(m, bearing);
}

bool CameraModel::contains(const Eigen::Vector2d& pixel, double border_px) const {
  return pixel.x() >= border_px && pixel.y() >= border_px && pixel.x() <= intrinsics_.resolution[0] - 1.0 - border_px &&
         pixel.y() <= intrinsics_.resolution[1] - 1.0 - border_px;
}

}  // namespace lxd
