// SPDX-License-Identifier: Apache-2.0
// Pinhole with distortion, in Kalibr's and OpenCV's convention. Camera frame: z forward, x right, y down. Pixels: the
// centre of the upper left one is (0, 0).
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace lxd::sim {

enum class Distortion { kNone, kRadtan, kEquidistant };

struct Intrinsics {
  Eigen::Vector2d focal_px{420, 420};
  Eigen::Vector2d centre_px{319.5, 239.5};
  Distortion distortion = Distortion::kRadtan;
  std::array<double, 4> coefficients{};  // k1, k2, p1, p2 (radtan); k1 .. k4 (equidistant)
};

class CameraModel {
 public:
  explicit CameraModel(const Intrinsics& intrinsics);

  // None: behind the camera, or so far outside that the distortion's polynomial folds back.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera) const;

  // The unit ray of a pixel, exact to 1e-12 of the image plane; none: the distortion reaches no ray there.
  [[nodiscard]] std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const;

 private:
  [[nodiscard]] double radial(double s) const;
  [[nodiscard]] double radial_slope(double s) const;
  [[nodiscard]] double first_fold(double limit) const;
  [[nodiscard]] std::optional<double> inverse_radial(double distorted) const;
  [[nodiscard]] Eigen::Vector2d distorted(const Eigen::Vector2d& x) const;
  [[nodiscard]] Eigen::Matrix2d distorted_slope(const Eigen::Vector2d& x) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> unproject_radtan(const Eigen::Vector2d& target) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> unproject_equidistant(const Eigen::Vector2d& target) const;

  Intrinsics intrinsics_;
  // Radius (radtan) or angle (equidistant) s goes to s * (1 + c0 s^2 + c1 s^4 + c2 s^6 + c3 s^8).
  std::array<double, 4> radial_{};
  double p1_ = 0, p2_ = 0;
  double s_max_ = 0;  // from here on the polynomial does not rise
};

}  // namespace lxd::sim
