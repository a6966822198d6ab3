// SPDX-License-Identifier: Apache-2.0
// A finished cloud goes where the corrected path has it.
#include <algorithm>
#include <vector>

#include "backend/cloud.hpp"

namespace lxd {
namespace {

struct Motion {
  double time_s;
  Eigen::Isometry3f T;  // from where it was to where it belongs
  bool kept;
};

Eigen::Isometry3f isometry(const Pose& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = pose.R;
  T.translation() = pose.p;
  return T.cast<float>();
}

// Of the pose whose stamp is nearest: a point has its sweep's.
const Motion& motion_at(const std::vector<Motion>& motions, double time_s) {
  const auto after = std::ranges::lower_bound(motions, time_s, {}, &Motion::time_s);
  if (after == motions.end()) return motions.back();
  if (after == motions.begin()) return *after;
  return after->time_s - time_s < time_s - std::prev(after)->time_s ? *after : *std::prev(after);
}

}  // namespace

Status move_cloud(const std::filesystem::path& cloud_ply, std::span<const StampedPose> from,
                  std::span<const StampedPose> to, const std::vector<bool>& kept) {
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < from.size(); ++i)
    motions.push_back({from[i].stamp.seconds(), isometry(to[i].T * from[i].T.inverse()), kept.empty() || kept[i]});
  if (motions.empty()) return success();
  auto reader = CloudReader::open(cloud_ply);
  if (!reader) return reader.error();
  auto writer = CloudWriter::create(cloud_ply, reader->coloured());
  if (!writer) return writer.error();
  std::vector<CloudPoint> moved;
  const Status done = reader->for_each_chunk([&](std::span<const CloudPoint> points) {
    moved.clear();
    for (const CloudPoint& point : points) {
      const Motion& motion = motion_at(motions, point.time_s);
      if (!motion.kept) continue;
      const Eigen::Vector3f p = motion.T * Eigen::Vector3f(point.x_m, point.y_m, point.z_m);
      moved.push_back({p.x(), p.y(), p.z(), point.intensity, point.time_s, point.colour});
    }
    return writer->append(moved);
  });
  return done ? writer->close() : done;
}

}  // namespace lxd
