// SPDX-License-Identifier: Apache-2.0
// Pinhole camera with distortion, in Kalibr's and OpenCV's convention, with the derivative of its projection. Camera
// frame: z forward, x right, y down. Pixels: the centre of the upper left one is (0, 0). Real-time safe.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

namespace lxd {

enum class Distortion : std::uint8_t { none, radtan, equidistant };

struct CameraIntrinsics {
  std::array<std::uint32_t, 2> resolution{};  // width, height; pixels
  Eigen::Vector2d focal_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  Distortion distortion = Distortion::none;
  std::array<double, 4> coefficients{};  // k1, k2, p1, p2 (radtan); k1 .. k4 (equidistant)
};

using ProjectionJacobian = Eigen::Matrix<double, 2, 3>;  // d pixel / d point, px/m

class CameraModel {
 public:
  CameraModel() = default;
  explicit CameraModel(const CameraIntrinsics& intrinsics);

  // False: behind the camera, or where the distortion's polynomial no longer rises. The pixel may be off the image.
  [[nodiscard]] bool project(const Eigen::Vector3d& p_camera_m, Eigen::Vector2d& pixel,
                             ProjectionJacobian* jacobian = nullptr) const noexcept;

  // The unit bearing of a pixel. False: no ray of the valid region reaches it, or the iteration does not converge.
  [[nodiscard]] bool unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& bearing) const noexcept;

  // Is the pixel on the image, at least `border` pixels from its edge?
  [[nodiscard]] bool contains(const Eigen::Vector2d& pixel, double border_px = 0) const;

  [[nodiscard]] const CameraIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  struct Bent {
    double value, slope;  // of the polynomial
  };
  [[nodiscard]] Bent bent(double s) const;
  [[nodiscard]] double first_fold(double limit) const;
  [[nodiscard]] bool straightened(double wanted, double& s) const;
  [[nodiscard]] Eigen::Vector2d distorted(const Eigen::Vector2d& x, Eigen::Matrix2d& slope) const;
  [[nodiscard]] bool image_plane(const Eigen::Vector3d& p, Eigen::Vector2d& m, ProjectionJacobian& J) const;
  [[nodiscard]] bool image_sphere(const Eigen::Vector3d& p, Eigen::Vector2d& m, ProjectionJacobian& J) const;
  [[nodiscard]] bool from_plane(const Eigen::Vector2d& m, Eigen::Vector3d& bearing) const;
  [[nodiscard]] bool from_sphere(const Eigen::Vector2d& m, Eigen::Vector3d& bearing) const;

  CameraIntrinsics intrinsics_;
  // Radius (radtan) or angle (equidistant) s goes to s (1 + c0 s^2 + c1 s^4 + c2 s^6 + c3 s^8).
  std::array<double, 4> radial_{};
  double p1_ = 0, p2_ = 0;
  double s_max_ = 0;  // from here on the polynomial does not rise
};

}  // namespace lxd
