// SPDX-License-Identifier: Apache-2.0
#include "backend/cloud_surface.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "backend/cloud.hpp"

namespace lxd {
namespace {

// Tells points in order of time.
class SurfaceTeller {
 public:
  SurfaceTeller(const Archive& archive, const CloudSurfaces& surfaces)
      : archive_(archive), surfaces_(surfaces), surface_(surfaces.radius_m) {}

  void tell(CloudPoint& point) {
    if (point.time_s != time_s_) look_at(point.time_s);
    if (loaded_) surface_.tell(point, eyes_);
  }

 private:
  // All points of a sweep have one time.
  void look_at(double time_s) {
    time_s_ = time_s;
    open_eyes();
    const auto& submeshes = surfaces_.submeshes;
    const auto after =
        std::ranges::find_if(submeshes.begin() + static_cast<std::ptrdiff_t>(loaded_.value_or(0)), submeshes.end(),
                             [&](const PlacedSubmesh& submesh) { return submesh.begin.seconds() > time_s; });
    if (after == submeshes.begin()) return;  // before all
    const auto wanted = static_cast<std::size_t>(after - submeshes.begin()) - 1;
    if (loaded_ != wanted) surface_.load(archive_, submeshes[wanted], surfaces_.coloured);
    loaded_ = wanted;
  }

  void open_eyes() {
    eyes_.clear();
    if (surfaces_.path.empty()) return;
    const Pose& pose = surfaces_.path[nearest_pose(surfaces_.path, time_s_)].T;
    for (const Eigen::Vector3d& sensor : surfaces_.sensors) eyes_.push_back(pose * sensor);
  }

  const Archive& archive_;
  const CloudSurfaces& surfaces_;
  PlacedSurface surface_;
  std::optional<std::size_t> loaded_;
  std::vector<Eigen::Vector3d> eyes_;
  double time_s_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

Status add_surfaces(const std::filesystem::path& cloud_ply, const Archive& archive, const CloudSurfaces& surfaces) {
  auto reader = CloudReader::open(cloud_ply);
  if (!reader) return reader.error();
  auto writer = CloudWriter::create(cloud_ply, {.surface = true, .colour = surfaces.coloured});
  if (!writer) return writer.error();
  SurfaceTeller teller(archive, surfaces);
  std::vector<CloudPoint> told;
  const Status done = reader->for_each_chunk([&](std::span<const CloudPoint> points) {
    told.assign(points.begin(), points.end());
    for (CloudPoint& point : told) teller.tell(point);
    return writer->append(told);
  });
  return done ? writer->close() : done;
}

}  // namespace lxd
