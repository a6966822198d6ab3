// SPDX-License-Identifier: Apache-2.0
#include "board/map_sink.hpp"

#include <utility>

#include "backend/mesh_export.hpp"
#include "backend/overview.hpp"
#include "backend/trajectory_writer.hpp"

namespace lxd {
namespace {

void keep_first(Status& first, Status status) {
  if (first && !status) first = std::move(status);
}

Status write_pictures(const RunFolder& folder, std::span<const StampedPose> path) {
  const auto archive = Archive::open(folder.file(run_files::kArchive));
  if (!archive) return archive.error();
  Status status = write_mesh_ply(folder.file(run_files::kMesh), *archive);
  const OverviewInfo info{.title = folder.path().filename().string(), .sweeps = path.size()};
  keep_first(status, write_overview(folder.file(run_files::kOverview), *archive, path, info));
  return status;
}

}  // namespace

Result<MapSink> MapSink::create(const RunFolder& folder, double cell_size_m, MeshExtraction& extraction) {
  auto archive = ArchiveWriter::create(folder.file(run_files::kArchive));
  if (!archive) return archive.error();
  auto cloud = CloudWriter::create(folder.file(run_files::kCloud));
  if (!cloud) return cloud.error();
  return MapSink(std::move(*archive), std::move(*cloud), cell_size_m, extraction);
}

MapSink::MapSink(ArchiveWriter archive, CloudWriter cloud, double cell_size_m, MeshExtraction& extraction)
    : archive_(std::move(archive)), cloud_(std::move(cloud)), cell_size_m_(cell_size_m), extraction_(&extraction) {}

Status MapSink::append(const SubMesh& sub_mesh) {
  const MeshExtraction::Mesh mesh = extraction_->extract(sub_mesh);
  SubmeshView view;
  view.id = sub_meshes_++;
  view.T_map_submesh.p = sub_mesh.origin().cast<double>() * cell_size_m_;
  view.first = sub_mesh.begin();
  view.last = sub_mesh.end();
  view.vertices = mesh.vertices;
  view.faces = mesh.faces;
  return archive_.append(view);
}

Status MapSink::append(const SweepOutcome& outcome) {
  const double time_s = outcome.stamp.seconds();
  points_.clear();
  for (const RegisteredPoint& point : outcome.registered) {
    const Eigen::Vector3f p = (outcome.registered_origin_m + point.position_m.cast<double>()).cast<float>();
    points_.push_back({p.x(), p.y(), p.z(), point.intensity, time_s});
  }
  return cloud_.append(points_);
}

Status MapSink::finish(const RunFolder& folder, std::span<const StampedPose> path) {
  Status first = archive_.append_poses(path);
  keep_first(first, archive_.finish());
  keep_first(first, cloud_.close());
  keep_first(first, write_trajectory(folder.file(run_files::kTrajectory), path));
  keep_first(first, write_pictures(folder, path));
  return first;
}

}  // namespace lxd
