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
  return PathWriter(std::move(*odometry), std::move(*covariance));
}

PathWriter::PathWriter(LineFile odometry, LineFile covariance)
    : odometry_(std::move(odometry)), covariance_(std::move(covariance)) {}

Status PathWriter::append(const StampedPose& pose, const PoseCovariance& covariance) {
  poses_.push_back(pose);
  const Status written = odometry_.append(tum_line(pose));
  if (!written) return written;
  return covariance_.append(covariance_line(pose.stamp, covariance));
}

}  // namespace lxd
