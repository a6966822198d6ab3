// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/triangulation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace lxd {
namespace {

constexpr double kMissSigmas = 3.0;
constexpr int kRefinements = 3;

double largest_parallax(std::span<const Sighting> sightings) {
  double least_cosine = 1;
  for (const Sighting& a : sightings)
    for (const Sighting& b : sightings)
      least_cosine = std::min(least_cosine, (a.T_world_camera.R * a.bearing).dot(b.T_world_camera.R * b.bearing));
  return std::acos(std::clamp(least_cosine, -1.0, 1.0));
}

// The DLT's equations d x (p - c) = 0 of all rays, each divided by its distance to the point so that a miss is an
// angle. With unit d they are the projector I - d d^T. The first round knows no distances.
struct LinearEquations {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();

  void add(const Sighting& sighting, double distance_m) {
    const Eigen::Vector3d d = sighting.T_world_camera.R * sighting.bearing;
    const Eigen::Matrix3d M = (Eigen::Matrix3d::Identity() - d * d.transpose()) / (distance_m * distance_m);
    A += M;
    b += M * sighting.T_world_camera.p;
  }
};

bool agrees(const Sighting& sighting, const Eigen::Vector3d& p_world_m, double sigma_rad) {
  const Eigen::Vector3d way = p_world_m - sighting.T_world_camera.p;
  const Eigen::Vector3d d = sighting.T_world_camera.R * sighting.bearing;
  return d.dot(way) > 0 && d.cross(way).norm() < kMissSigmas * sigma_rad * way.norm();
}

}  // namespace

bool triangulate(std::span<const Sighting> sightings, double bearing_sigma_rad, double parallax_min_rad,
                 Triangulation& out) noexcept {
  if (sightings.size() < kSightingsMin) return false;
  out.parallax_rad = largest_parallax(sightings);
  if (!(out.parallax_rad >= parallax_min_rad)) return false;
  LinearEquations first;
  for (const Sighting& sighting : sightings) first.add(sighting, 1);
  out.p_world_m = first.A.ldlt().solve(first.b);
  LinearEquations scaled;
  for (int i = 0; i < kRefinements; ++i) {
    scaled = {};
    for (const Sighting& s : sightings) scaled.add(s, (out.p_world_m - s.T_world_camera.p).norm());
    out.p_world_m = scaled.A.ldlt().solve(scaled.b);
  }
  out.covariance_m2 = bearing_sigma_rad * bearing_sigma_rad * scaled.A.ldlt().solve(Eigen::Matrix3d::Identity());
  return out.covariance_m2.allFinite() && std::all_of(sightings.begin(), sightings.end(), [&](const Sighting& s) {
           return agrees(s, out.p_world_m, bearing_sigma_rad);
         });
}

}  // namespace lxd
