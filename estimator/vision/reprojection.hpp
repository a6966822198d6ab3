// SPDX-License-Identifier: Apache-2.0
// Visual reprojection residuals (paper, "Visual Reprojection Constraints") of an image that was taken tau before the
// sweep's end.
//
// r = pi(R_CB R(tau)^T (p_w - p(tau)) + t_CB) - z in pixels, through the lens' distortion. A landmark that rests in the
// world moves in the body as a point of the body would, backwards: with q = R(tau)^T (p_w - p(tau)) and a row n^T of
// A = d pi R_CB R(tau)^T, the row is that of -n^T (R(tau) q + p(tau)), which is -row_along().
// Real-time thread; README.md derives them.
#pragma once

#include <span>

#include <Eigen/Core>

#include "estimator/normal_equations.hpp"
#include "estimator/sweep_path.hpp"
#include "estimator/vision/camera_model.hpp"

namespace lxd {

// A camera on its carrier.
struct MountedCamera {
  CameraModel model;
  Pose T_body_camera;
  // An instant's image is stamped so much later, and how sure that is; 0: exactly.
  double delay_s = 0, delay_sigma_s = 0;
  double rotation_sigma_rad = 0;  // of T_body_camera, about an axis; 0: exactly
};

// A feature seen in an image: where it is in the world, as its depth filter knows, and where it was seen.
struct VisualObservation {
  Eigen::Vector3d p_world_m;
  Eigen::Matrix3d covariance_m2;  // of p_world_m: depth and anchor; not estimated
  Eigen::Vector2d pixel;
};

struct VisualResidual {
  Eigen::Vector2d r_px;
  Eigen::Matrix2d covariance_px2;            // tracking, and the landmark's projected
  Eigen::Matrix<double, 2, kLidarDim> rows;  // dr / d(end state)
};

// False: the point is behind the camera or beyond what its model knows, or something is no number.
bool reproject(const VisualObservation& observation, const PathKnot& knot, const MountedCamera& camera,
               double pixel_sigma_px, VisualResidual& residual) noexcept;

// r^T covariance^-1 r: two degrees of freedom.
double squared_ratio(const VisualResidual& residual);

// Robust scale, at least 1: root of the median squared ratio over that of its distribution. `scratch` holds at least as
// many floats as residuals.
double visual_scale(std::span<const VisualResidual> residuals, std::span<float> scratch);

// The sums of the images' residuals, robustly weighted as those of the LiDAR, to be added to those. Their `weight` is
// the trace of the position's information, 1/m^2, as the LiDAR's is.
NormalEquations accumulate(std::span<const VisualResidual> residuals, double scale, double kernel_sigmas);

// An image's pose differs from what the path says of its time by an error common to all its rows, of variance
// `pose_variance` ([rotation, position], rad^2 and m^2): it is taken out of the sums as if it had been estimated with
// the state (Schur complement). However many landmarks there are, the image then tells no more than the path allows.
void marginalise(const Vector6d& pose_variance, NormalEquations& sums);

NormalEquations& operator+=(NormalEquations& sums, const NormalEquations& others);

}  // namespace lxd
