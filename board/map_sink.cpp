// SPDX-License-Identifier: Apache-2.0
#include "board/map_sink.hpp"

#include <utility>

#include "backend/cloud_surface.hpp"
#include "backend/mesh_export.hpp"
#include "backend/overview.hpp"
#include "backend/trajectory_writer.hpp"
#include "mapping/lattice.hpp"

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

Result<MapSink> MapSink::create(const RunFolder& folder, const Configuration& configuration, const Star& star,
                                MeshExtraction& extraction, const std::optional<EarlierMap>& earlier,
                                BackEndPace pace) {
  auto archive = ArchiveWriter::create(folder.file(run_files::kArchive));
  if (!archive) return archive.error();
  std::optional<CloudWriter> cloud;
  if (!earlier || !earlier->localise) {
    auto made = CloudWriter::create(folder.file(run_files::kCloud));
    if (!made) return made.error();
    cloud.emplace(std::move(*made));
  }
  auto beams = MapBeams::create(folder.path());
  if (!beams) return beams.error();
  MapSink sink(std::move(*archive), std::move(cloud), std::move(*beams), configuration.settings.mapping.cell_size_m,
               extraction);
  if (sink.keeps_map()) sink.colours_ = MapColours::create(configuration, star, pace);
  const Pose T_reference_body = star.T_body_reference.inverse();
  sink.lidars_.push_back(T_reference_body * star.T_body_lidar0.p);
  if (star.T_body_lidar1) sink.lidars_.push_back(T_reference_body * star.T_body_lidar1->p);
  if (!earlier) return sink;
  sink.earlier_ = earlier;
  sink.first_id_ = earlier->archive->totals().last_id + 1;
  sink.session_ = earlier->archive->totals().sessions;
  return sink;
}

MapSink::MapSink(ArchiveWriter archive, std::optional<CloudWriter> cloud, MapBeams beams, double cell_size_m,
                 MeshExtraction& extraction)
    : archive_(std::move(archive)),
      cloud_(std::move(cloud)),
      beams_(std::move(beams)),
      cell_size_m_(cell_size_m),
      extraction_(&extraction) {}

// On the disk before anybody looks for loops in it or tells its colours: that takes its time. The colours of the last
// one are there before its storage is used again.
Status MapSink::append(const SubMesh& sub_mesh, MapKeeper& keeper) {
  Status kept = colours_ ? colours_->collect(archive_, MapColours::Waiting::next_submesh) : success();
  const MeshExtraction::Mesh mesh = extract(sub_mesh, kept);
  SubmeshView view;
  view.id = first_id_ + static_cast<std::int64_t>(sub_meshes_.size());
  view.session = session_;
  view.T_map_submesh.p = sub_mesh.origin().cast<double>() * cell_size_m_;
  view.first = sub_mesh.begin();
  view.last = sub_mesh.end();
  view.vertices = mesh.vertices;
  view.faces = mesh.faces;
  const std::vector<SubmeshKeyFrame> key_frames = keeper.key_frames_of(view);
  view.key_frames = key_frames;
  sub_meshes_.push_back({view.first, view.T_map_submesh});
  if (keeps_map()) keep_first(kept, archive_.append(view));
  if (colours_) colours_->begin(view);
  keeper.take(view);
  return kept;
}

// Its surfaces, without what beams went through.
MeshExtraction::Mesh MapSink::extract(const SubMesh& sub_mesh, Status& kept) {
  const BeamLog* const log = beams_.of(sub_mesh.begin());
  if (log == nullptr) {
    NoBeams none;
    return extraction_->extract(sub_mesh, none);
  }
  BeamReader reader(*log);
  const MeshExtraction::Mesh mesh = extraction_->extract(sub_mesh, reader);
  keep_first(kept, reader.status());
  return mesh;
}

Status MapSink::append(const SweepOutcome& outcome, RigTime sub_mesh_begin) {
  Status noted = beams_.take(outcome, sub_mesh_begin);
  if (!keeps_map()) return noted;
  const double time_s = outcome.stamp.seconds();
  points_.clear();
  for (const RegisteredPoint& point : outcome.registered) {
    const Eigen::Vector3f p = (outcome.registered_origin_m + point.position_m.cast<double>()).cast<float>();
    points_.push_back({p.x(), p.y(), p.z(), point.intensity, time_s});
  }
  keep_first(noted, cloud_->append(points_));
  return noted;
}

// Their surfaces stay as they are: each goes as one.
Status MapSink::move_sub_meshes(const CorrectedPath& corrections) {
  for (std::size_t i = 0; i < sub_meshes_.size(); ++i) {
    const Stored& stored = sub_meshes_[i];
    const auto T_map_world = corrections.sub_mesh(stored.begin);
    const Pose T_map = T_map_world ? *T_map_world * stored.T_world : corrections.correct(stored.begin, stored.T_world);
    Status moved = archive_.set_pose(first_id_ + static_cast<std::int64_t>(i), T_map, corrections.piece(stored.begin));
    if (!moved) return moved;
  }
  return success();
}

// The earlier map as it is, but for pieces that it did not know the place of.
Status MapSink::add_earlier() {
  Status first = earlier_->archive->for_each_submesh([this](const SubmeshView& view) { return archive_.append(view); });
  for (std::int64_t session = 0; session < session_; ++session) {
    const auto poses = earlier_->archive->poses(session);
    keep_first(first, poses ? archive_.append_poses(*poses, session) : Status(poses.error()));
  }
  return first;
}

// In two steps, each whole or not at all: where this run's map belongs; then what it continues.
Status MapSink::finish_archive(std::span<const StampedPose> corrected, const CorrectedPath& corrections) {
  Status first = archive_.all_or_nothing([&] {
    const bool moved = corrections.moved() || corrections.in_pieces();
    Status done = moved ? move_sub_meshes(corrections) : success();
    return done ? archive_.append_poses(corrected, session_) : done;
  });
  if (keeps_map() && earlier_ && corrections.main() == kEarlierMap)
    keep_first(first, archive_.all_or_nothing([this] { return add_earlier(); }));
  keep_first(first, archive_.finish());
  return first;
}

// In the filter's world, where sub-meshes and points agree.
Status MapSink::add_cloud_surfaces(const RunFolder& folder, std::span<const StampedPose> path) const {
  const auto archive = Archive::open(folder.file(run_files::kArchive));
  if (!archive) return archive.error();
  std::vector<PlacedSubmesh> placed;
  for (std::size_t i = 0; i < sub_meshes_.size(); ++i)
    placed.push_back({sub_meshes_[i].begin, first_id_ + static_cast<std::int64_t>(i), sub_meshes_[i].T_world});
  return add_surfaces(folder.file(run_files::kCloud), *archive,
                      {.submeshes = placed,
                       .path = path,
                       .sensors = lidars_,
                       .radius_m = cell_size_m_ / kQuadsPerEdge,
                       .coloured = colours_ && colours_->any()});
}

Status MapSink::finish(const RunFolder& folder, std::span<const StampedPose> path, const CorrectedPath& corrections) {
  std::vector<StampedPose> corrected, in_map;
  std::vector<bool> kept;
  for (const StampedPose& pose : path) {
    corrected.push_back({pose.stamp, corrections.correct(pose.stamp, pose.T)});
    kept.push_back(corrections.piece(pose.stamp) == 0);
    if (kept.back()) in_map.push_back(corrected.back());
  }
  Status first = colours_ ? colours_->collect(archive_, MapColours::Waiting::nobody) : success();
  keep_first(first, finish_archive(in_map, corrections));
  keep_first(first, write_trajectory(folder.file(run_files::kTrajectory), in_map));
  if (!keeps_map()) return first;
  const Status cloud = cloud_->close();
  if (cloud) keep_first(first, add_cloud_surfaces(folder, path));
  if (cloud && (corrections.moved() || corrections.in_pieces()))
    keep_first(first, move_cloud(folder.file(run_files::kCloud), path, corrected, kept));
  keep_first(first, cloud);
  keep_first(first, write_pictures(folder, in_map));
  return first;
}

}  // namespace lxd
