// SPDX-License-Identifier: Apache-2.0
// What the filter says of one sweep.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "estimator/innovation.hpp"
#include "estimator/motion_source.hpp"
#include "rt/pose.hpp"
#include "rt/time.hpp"

namespace lxd {

// Wall time of each stage of a sweep's life.
struct StageTimes {
  Duration predict, rotation_guess, deskew, downsample, lidar_update, visual_update, raycast, meshing;
};

// Which sensors had a part in a pose.
struct SensorsAtWork {
  bool primary_lidar = false;                                            // the sweep held the pose
  bool extra_lidar = false, camera = false, imu = false, wheel = false;  // heard of lately, and believed
};

enum class SweepRejection : std::uint8_t { none, time_backwards, too_few_points };

struct RegisteredPoint {
  Eigen::Vector3f position_m;  // world axes, relative to SweepOutcome::registered_origin_m
  float intensity;
  float to_come;  // share of the sweep's span that was still to come when it was seen, 0..1
};

struct SweepOutcome {
  SweepRejection rejection = SweepRejection::none;  // other than none: nothing below is new
  RigTime stamp;                                    // of the published pose
  Pose T_world_body;                                // at stamp
  Eigen::Matrix<double, 6, 6> covariance =
      Eigen::Matrix<double, 6, 6>::Zero();  // of it: [rotation (body, right), position (world)], rad and m
  MotionSource source = MotionSource::constant_velocity;  // of the prediction
  SensorsAtWork at_work;
  Duration camera_delay;                                        // an instant's image is stamped so much later
  Eigen::Matrix3d R_body_camera = Eigen::Matrix3d::Identity();  // as it is mounted, if one is in use
  bool carried = false;  // the primary LiDAR was silent: the others carried the pose on
  bool tracked = false;  // the update had enough surfaces and agreed with them; otherwise the pose is the prediction
  bool over_budget = false;                // it took longer than its budget: the next ones shed points
  std::uint8_t degenerate_directions = 0;  // how many of the six the geometry did not hold
  std::uint32_t points_used = 0;           // residuals in the last iteration
  std::uint32_t iterations = 0;
  std::uint64_t not_finite_updates =
      0;                      // since the start: updates without a solution that a body could follow, rejected
  double residual_scale = 1;  // robust scale of the residuals by their own sigma, >= 1
  double agreement = 0;       // of the sweep with the map, 0..1
  Innovation innovation;      // of the update, when tracked
  StageTimes times;
  Eigen::Vector3d registered_origin_m = Eigen::Vector3d::Zero();
  std::span<const RegisteredPoint> registered;  // thinned points of the sweep, for the cloud; valid until the next step
  std::uint32_t registered_primary = 0;         // so many of them, the first ones, are the primary LiDAR's
  // Where that was when the sweep's span began and ended, as the points.
  Eigen::Vector3f lidar_then_m = Eigen::Vector3f::Zero(), lidar_m = Eigen::Vector3f::Zero();
};

}  // namespace lxd
