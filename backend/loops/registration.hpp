// SPDX-License-Identifier: Apache-2.0
// Registration of one place's surfaces against another's: point to plane with the map's own variances, robust, coarse
// to fine, and the information that it leaves about the relative pose.
#pragma once

#include <span>

#include <Eigen/Core>

#include "backend/loop_measurement.hpp"
#include "backend/loops/surfel_grid.hpp"
#include "backend/loops/surfels.hpp"
#include "rt/pose.hpp"

namespace lxd {

struct RegistrationConfig {
  double coarse_voxel_m = 0.9;     // of both places' surfels at first
  double fine_reach_m = 0.5;       // to the nearest surfel in the end
  double coarse_reach_m = 2.0;     // and at first
  int iterations_max = 8;          // of each of the levels
  double floor_sigma_m = 0.01;     // of a residual, besides the map's variances: bending within a sub-mesh
  double normal_sigma_rad = 0.05;  // of the surfels' normals, as the filter has it
  double tilt_sigma_rad = 0.02;    // both places are level by the same gravity
};

struct Registration {
  Pose T_candidate_query;
  // H^T W H of the pose as [rotation (right), position], plain weights, before any discount.
  Matrix6d information = Matrix6d::Zero();
  // The same by errors of the normals alone: what a direction has of it though nothing holds it.
  Matrix6d noise = Matrix6d::Zero();
  int pairs = 0;     // residuals of the last iteration
  double rms_m = 0;  // of them, robust
};

class SurfaceRegistration {
 public:
  // Surfaces about the candidate's key frame, level.
  SurfaceRegistration(std::span<const Surfel> candidate, const RegistrationConfig& config);

  // Surfaces about the query's key frame, level; at most a few thousand of them are enough.
  [[nodiscard]] Registration run(std::span<const Surfel> query, const Pose& T_candidate_query) const;
  [[nodiscard]] const SurfelGrid& fine() const { return fine_; }

 private:
  struct Level {
    const SurfelGrid* grid;
    double reach_m;
  };
  struct Sums;
  [[nodiscard]] Sums accumulate(std::span<const Surfel> query, const Pose& T, const Level& level) const;
  void iterate(std::span<const Surfel> query, const Level& level, Registration& out) const;

  RegistrationConfig config_;
  SurfelGrid coarse_, fine_;
};

}  // namespace lxd
