// SPDX-License-Identifier: Apache-2.0
#include "board/path_writer.hpp"

#include <utility>

#include "backend/trajectory_writer.hpp"

namespace lxd {
Result<PathWriter> PathWriter::create(const RunFolder& folder) {
  auto odometry = LineFile::create(folder.file(run_files::kOdometry));
  if (!odometry) return odometry.error();
  auto covariance = LineFile::create(folder.file(run_files::kCovariance));
  if (!covariance) return covariance.error();
  auto innovation = LineFile::create(folder.file(run_files::kInnovation));
  if (!innovation) return innovation.error();
  return PathWriter(std::move(*odometry), std::move(*covariance), std::move(*innovation));
}

PathWriter::PathWriter(LineFile odometry, LineFile covariance, LineFile innovation)
    : odometry_(std::move(odometry)), covariance_(std::move(covariance)), innovation_(std::move(innovation)) {}

Status PathWriter::append(const StampedPose& pose, const PoseCovariance& covariance, const Innovation& innovation) {
  poses_.push_back(pose);
  Status first = odometry_.append(tum_line(pose));
  Status second = covariance_.append(covariance_line(pose.stamp, covariance));
  if (first) first = std::move(second);
  if (innovation.dimensions == 0) return first;
  second = innovation_.append(innovation_line(pose.stamp, innovation.squared, innovation.dimensions));
  return first ? second : first;
}

}  // namespace lxd
