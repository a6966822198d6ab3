// SPDX-License-Identifier: Apache-2.0
// A finished cloud goes where the corrected path has it.
#include <vector>

#include "backend/cloud.hpp"

namespace lxd {
namespace {

// Of all points seen from one pose.
struct Motion {
  Eigen::Isometry3f T;  // from where it was to where it belongs
  bool kept;
};

Eigen::Isometry3f isometry(const Pose& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = pose.R;
  T.translation() = pose.p;
  return T.cast<float>();
}

CloudPoint moved_point(CloudPoint point, const Eigen::Isometry3f& T) {
  const Eigen::Vector3f p = T * Eigen::Vector3f(point.x_m, point.y_m, point.z_m);
  const Eigen::Vector3f normal = T.linear() * Eigen::Vector3f(point.surface.nx, point.surface.ny, point.surface.nz);
  point.x_m = p.x(), point.y_m = p.y(), point.z_m = p.z();
  point.surface.nx = normal.x(), point.surface.ny = normal.y(), point.surface.nz = normal.z();
  return point;
}

}  // namespace

Status move_cloud(const std::filesystem::path& cloud_ply, std::span<const StampedPose> from,
                  std::span<const StampedPose> to, const std::vector<bool>& kept) {
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < from.size(); ++i)
    motions.push_back({isometry(to[i].T * from[i].T.inverse()), kept.empty() || kept[i]});
  if (motions.empty()) return success();
  auto reader = CloudReader::open(cloud_ply);
  if (!reader) return reader.error();
  auto writer = CloudWriter::create(cloud_ply, reader->fields());
  if (!writer) return writer.error();
  std::vector<CloudPoint> there;
  const Status done = reader->for_each_chunk([&](std::span<const CloudPoint> points) {
    there.clear();
    for (const CloudPoint& point : points) {
      const Motion& motion = motions[nearest_pose(from, point.time_s)];
      if (motion.kept) there.push_back(moved_point(point, motion.T));
    }
    return writer->append(there);
  });
  return done ? writer->close() : done;
}

}  // namespace lxd
