// SPDX-License-Identifier: Apache-2.0
// Text of poses and covariances.
#include "backend/trajectory_writer.hpp"

#include <fmt/format.h>

namespace lxd {
namespace {

Eigen::Quaterniond canonical(const Pose& T) {
  Eigen::Quaterniond q = T.quaternion();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  q.coeffs().array() += 0.0;  // no zero has a sign
  return q;
}

}  // namespace

std::string seconds_text(RigTime stamp) {
  const std::uint64_t magnitude = stamp.ns() < 0 ? 0 - static_cast<std::uint64_t>(stamp.ns()) : stamp.ns();
  constexpr auto kPerSecond = static_cast<std::uint64_t>(kNanosPerSecond);
  return fmt::format("{}{}.{:09}", stamp.ns() < 0 ? "-" : "", magnitude / kPerSecond, magnitude % kPerSecond);
}

std::string tum_line(const StampedPose& pose) {
  const Eigen::Quaterniond q = canonical(pose.T);
  return fmt::format("{} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}\n", seconds_text(pose.stamp),
                     pose.T.p.x(), pose.T.p.y(), pose.T.p.z(), q.x(), q.y(), q.z(), q.w());
}

std::string kitti_line(const StampedPose& pose) {
  std::string line;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) line += fmt::format("{:.12f} ", pose.T.R(row, column));
    line += fmt::format("{:.9f}{}", pose.T.p[row], row < 2 ? ' ' : '\n');
  }
  return line;
}

std::string covariance_line(RigTime stamp, const PoseCovariance& covariance) {
  std::string line = seconds_text(stamp);
  for (int row = 0; row < covariance.rows(); ++row)
    for (int column = row; column < covariance.cols(); ++column)
      line += fmt::format(" {:.9e}", covariance(row, column));
  return line + '\n';
}

std::string innovation_line(RigTime stamp, double nis, int dimensions) {
  return fmt::format("{} {:.9e} {}\n", seconds_text(stamp), nis, dimensions);
}

Result<TrajectoryWriter> TrajectoryWriter::create(const std::filesystem::path& path, TrajectoryFormat format) {
  Result<PartFile> file = PartFile::create(path);
  if (!file.ok()) return file.error();
  return TrajectoryWriter(std::move(*file), format);
}

Status TrajectoryWriter::append(const StampedPose& pose) {
  file_.write_text(format_ == TrajectoryFormat::tum ? tum_line(pose) : kitti_line(pose));
  return file_.status();
}

Status TrajectoryWriter::close() { return file_.commit(); }

Status write_trajectory(const std::filesystem::path& path, std::span<const StampedPose> poses) {
  const std::string ending = path.extension().string();
  if (ending != ".tum" && ending != ".txt" && ending != ".kitti")
    return Error{fmt::format("{}: found ending '{}', wanted .tum or .kitti", path.string(), ending)};
  Result<TrajectoryWriter> writer =
      TrajectoryWriter::create(path, ending == ".kitti" ? TrajectoryFormat::kitti : TrajectoryFormat::tum);
  if (!writer.ok()) return writer.error();
  for (const StampedPose& pose : poses)
    if (const Status written = writer->append(pose); !written.ok()) return written;
  return writer->close();
}

}  // namespace lxd
