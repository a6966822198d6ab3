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

Status MapSink::append(const SubMesh& sub_mesh, const SubmeshObserver& see) {
  const MeshExtraction::Mesh mesh = extraction_->extract(sub_mesh);
  SubmeshView view;
  view.id = static_cast<std::int64_t>(sub_meshes_.size());
  view.T_map_submesh.p = sub_mesh.origin().cast<double>() * cell_size_m_;
  view.first = sub_mesh.begin();
  view.last = sub_mesh.end();
  view.vertices = mesh.vertices;
  view.faces = mesh.faces;
  see(view);
  sub_meshes_.push_back({view.first, view.T_map_submesh});
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

// Their surfaces stay as they are: each goes as one.
Status MapSink::move_sub_meshes(const CorrectedPath& corrections) {
  for (std::size_t id = 0; id < sub_meshes_.size(); ++id) {
    const Stored& stored = sub_meshes_[id];
    const auto T_map_world = corrections.sub_mesh(stored.begin);
    const Pose T_map = T_map_world ? *T_map_world * stored.T_world : corrections.correct(stored.begin, stored.T_world);
    const Status moved = archive_.set_pose(static_cast<std::int64_t>(id), T_map);
    if (!moved) return moved;
  }
  return success();
}

Status MapSink::finish(const RunFolder& folder, std::span<const StampedPose> path, const CorrectedPath& corrections) {
  std::vector<StampedPose> corrected;
  for (const StampedPose& pose : path) corrected.push_back({pose.stamp, corrections.correct(pose.stamp, pose.T)});
  Status first = corrections.moved() ? move_sub_meshes(corrections) : success();
  keep_first(first, archive_.append_poses(corrected));
  keep_first(first, archive_.finish());
  const Status cloud = cloud_.close();
  if (cloud && corrections.moved()) keep_first(first, move_cloud(folder.file(run_files::kCloud), path, corrected));
  keep_first(first, cloud);
  keep_first(first, write_trajectory(folder.file(run_files::kTrajectory), corrected));
  keep_first(first, write_pictures(folder, corrected));
  return first;
}

}  // namespace lxd
