// SPDX-License-Identifier: Apache-2.0
// Radial-tangential: Brown's model as OpenCV's calib3d documents it; equidistant: Kannala and Brandt, TPAMI 2006.
#include "tools/simulator/camera/camera_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace lxd::sim {
namespace {

constexpr double kWidestRadius = 20;  // tan 87 degrees: no pinhole sees more
constexpr double kWidestAngle_rad = std::numbers::pi;
constexpr double kScanStep = 1e-3;
constexpr double kConverged = 2e-15;
constexpr double kAccepted = 1e-12;
constexpr int kIterationsMax = 60;

}  // namespace

CameraModel::CameraModel(const Intrinsics& intrinsics) : intrinsics_(intrinsics) {
  const auto& k = intrinsics.coefficients;
  if (intrinsics.distortion == Distortion::kEquidistant) radial_ = k;
  if (intrinsics.distortion == Distortion::kRadtan) {
    radial_ = {k[0], k[1], 0, 0};
    p1_ = k[2];
    p2_ = k[3];
  }
  s_max_ = first_fold(intrinsics.distortion == Distortion::kEquidistant ? kWidestAngle_rad : kWidestRadius);
}

double CameraModel::radial(double s) const {
  const double s2 = s * s;
  return s * (1 + s2 * (radial_[0] + s2 * (radial_[1] + s2 * (radial_[2] + s2 * radial_[3]))));
}

double CameraModel::radial_slope(double s) const {
  const double s2 = s * s;
  return 1 + s2 * (3 * radial_[0] + s2 * (5 * radial_[1] + s2 * (7 * radial_[2] + s2 * 9 * radial_[3])));
}

double CameraModel::first_fold(double limit) const {
  for (double s = 0; s < limit; s += kScanStep) {
    if (radial_slope(s) <= 0) return s;
  }
  return limit;
}

// Newton's steps, kept within a bracket that shrinks.
std::optional<double> CameraModel::inverse_radial(double wanted) const {
  double low = 0, high = s_max_;
  if (wanted > radial(high)) return std::nullopt;
  double s = std::min(wanted, high);
  for (int i = 0; i < kIterationsMax && high - low > kConverged; ++i) {
    const double error = radial(s) - wanted;
    if (std::abs(error) < kConverged) break;
    (error > 0 ? high : low) = s;
    const double slope = radial_slope(s);
    const double next = slope > 0 ? s - error / slope : low;
    s = next > low && next < high ? next : (low + high) / 2;
  }
  return s;
}

Eigen::Vector2d CameraModel::distorted(const Eigen::Vector2d& x) const {
  const double r2 = x.squaredNorm(), xy = x.x() * x.y();
  const double scale = 1 + r2 * (radial_[0] + r2 * radial_[1]);
  return {x.x() * scale + 2 * p1_ * xy + p2_ * (r2 + 2 * x.x() * x.x()),
          x.y() * scale + p1_ * (r2 + 2 * x.y() * x.y()) + 2 * p2_ * xy};
}

Eigen::Matrix2d CameraModel::distorted_slope(const Eigen::Vector2d& x) const {
  const double r2 = x.squaredNorm();
  const double scale = 1 + r2 * (radial_[0] + r2 * radial_[1]);
  const double scale_slope = 2 * radial_[0] + 4 * radial_[1] * r2;  // times x: the gradient of scale
  const double mixed = scale_slope * x.x() * x.y() + 2 * (p1_ * x.x() + p2_ * x.y());
  Eigen::Matrix2d J;
  J << scale + scale_slope * x.x() * x.x() + 2 * p1_ * x.y() + 6 * p2_ * x.x(), mixed,  //
      mixed, scale + scale_slope * x.y() * x.y() + 6 * p1_ * x.y() + 2 * p2_ * x.x();
  return J;
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& p_camera) const {
  Eigen::Vector2d image;
  if (intrinsics_.distortion == Distortion::kEquidistant) {
    const double r = p_camera.head<2>().norm();
    const double angle = std::atan2(r, p_camera.z());
    if (angle >= s_max_) return std::nullopt;
    image = r > 0 ? Eigen::Vector2d(p_camera.head<2>() * (radial(angle) / r)) : Eigen::Vector2d::Zero();
  } else {
    if (p_camera.z() <= 0) return std::nullopt;
    const Eigen::Vector2d x = p_camera.head<2>() / p_camera.z();
    if (x.norm() >= s_max_) return std::nullopt;
    image = distorted(x);
  }
  return intrinsics_.focal_px.cwiseProduct(image) + intrinsics_.centre_px;
}

std::optional<Eigen::Vector3d> CameraModel::unproject(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d target = (pixel - intrinsics_.centre_px).cwiseQuotient(intrinsics_.focal_px);
  return intrinsics_.distortion == Distortion::kEquidistant ? unproject_equidistant(target) : unproject_radtan(target);
}

// The radial part alone is solved first: it is safe at any radius. What is tangential is small, and Newton's.
std::optional<Eigen::Vector3d> CameraModel::unproject_radtan(const Eigen::Vector2d& target) const {
  const double r_distorted = target.norm();
  if (r_distorted == 0) return Eigen::Vector3d::UnitZ();
  Eigen::Vector2d x = target * (inverse_radial(r_distorted).value_or(s_max_) / r_distorted);
  for (int i = 0; i < kIterationsMax; ++i) {
    const Eigen::Vector2d step = distorted_slope(x).inverse() * (target - distorted(x));
    x += step;
    if (!(step.norm() > kConverged)) break;
  }
  if (!((distorted(x) - target).norm() < kAccepted) || x.norm() >= s_max_) return std::nullopt;
  return Eigen::Vector3d(x.x(), x.y(), 1).normalized();
}

std::optional<Eigen::Vector3d> CameraModel::unproject_equidistant(const Eigen::Vector2d& target) const {
  const double distorted_angle = target.norm();
  if (distorted_angle == 0) return Eigen::Vector3d::UnitZ();
  const auto angle = inverse_radial(distorted_angle);
  if (!angle || *angle >= s_max_) return std::nullopt;
  const Eigen::Vector2d direction = target / distorted_angle;
  return Eigen::Vector3d(direction.x() * std::sin(*angle), direction.y() * std::sin(*angle), std::cos(*angle));
}

}  // namespace lxd::sim
