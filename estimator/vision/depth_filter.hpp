// SPDX-License-Identifier: Apache-2.0
// A feature's inverse distance along its bearing from an anchor frame, as a Gaussian (paper, "Visual Feature Lifecycle
// and Depth Filtering"). Distance along the ray instead of depth along the axis, so that wide lenses have no edge.
// Real-time safe.
#pragma once

#include <Eigen/Core>

#include "estimator/vision/camera_model.hpp"
#include "rt/pose.hpp"

namespace lxd {

inline constexpr double kInverseDistanceMin = 0.002;  // 1/m: what is farther is as good as this
inline constexpr double kInverseDistanceMax = 20;     // and nothing is nearer

struct InverseDepth {
  double rho = 0;       // 1/m
  double variance = 0;  // 1/m^2
};

// Of a distance d with its variance: sigma^2 / d^4 (paper, eq. of sigma_rho_obs^2).
InverseDepth inverse_of(double distance_m, double variance_m2);

// The paper's one-dimensional Kalman filter: K, mu_post and sigma_post^2.
InverseDepth fused(const InverseDepth& prior, const InverseDepth& observed);

// Squared difference over its variance; one degree of freedom.
double squared_difference(const InverseDepth& a, const InverseDepth& b);

// The same point seen from another frame: new bearing and inverse distance, the variance by its derivative.
struct AnchoredPoint {
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  // unit, in the anchor's camera frame
  InverseDepth depth;
};
AnchoredPoint shifted(const AnchoredPoint& point, const Pose& T_new_old);

// What the pixel in which the point was seen says of its distance: a Kalman step with the projection as measurement.
// Gives the squared innovation (two degrees of freedom); the point is left as it is when that is above `gate` or the
// point cannot be seen there (then infinity).
double update_by_pixel(AnchoredPoint& point, const Pose& T_camera_anchor, const CameraModel& camera,
                       const Eigen::Vector2d& pixel, double sigma_px, double gate);

}  // namespace lxd
