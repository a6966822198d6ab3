// SPDX-License-Identifier: Apache-2.0
// Path files as evo and the KITTI tools read them, written pose by pose.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <Eigen/Core>

#include "backend/part_file.hpp"
#include "backend/trajectory.hpp"
#include "rt/result.hpp"

namespace lxd {

// Seconds with nine decimals, exact to the nanosecond: a double holds today's Unix time to 240 ns only.
std::string seconds_text(RigTime stamp);
// `t tx ty tz qx qy qz qw`: seconds, metres, unit quaternion with qw >= 0.
std::string tum_line(const StampedPose& pose);
// The upper three rows of T, row by row; no time.
std::string kitti_line(const StampedPose& pose);
// `t` and the upper triangle, row by row, of the 6x6 covariance of the pose's error in the order [rotation, position]:
// R_true = R Exp(rotation) (body frame, rad), p_true = p + position (world frame, m). `evaluate` reads it for the NEES.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;
std::string covariance_line(RigTime stamp, const PoseCovariance& covariance);
// `t nis dimensions`: the normalised innovation squared of the update at t and its degrees of freedom. `evaluate` reads
// it for the NIS.
std::string innovation_line(RigTime stamp, double nis, int dimensions);

enum class TrajectoryFormat { tum, kitti };

class TrajectoryWriter {
 public:
  static Result<TrajectoryWriter> create(const std::filesystem::path& path, TrajectoryFormat format);
  Status append(const StampedPose& pose);
  Status close();

 private:
  TrajectoryWriter(PartFile file, TrajectoryFormat format) : file_(std::move(file)), format_(format) {}
  PartFile file_;
  TrajectoryFormat format_;
};

// By the ending: .tum (or .txt) or .kitti. Error: ending unknown, writing.
Status write_trajectory(const std::filesystem::path& path, std::span<const StampedPose> poses);

}  // namespace lxd
