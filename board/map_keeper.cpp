// SPDX-License-Identifier: Apache-2.0
#include "board/map_keeper.hpp"

#include <algorithm>
#include <map>

#include "board/default/capacities.hpp"
#include "board/image_follower.hpp"

namespace lxd {
namespace {

// What of a sub-mesh the search for loops needs, while the sub-mesh itself is given back.
struct KeptSurface {
  explicit KeptSurface(const SubmeshView& view)
      : id(view.id), T_world_submesh(view.T_map_submesh), vertices(view.vertices.begin(), view.vertices.end()) {}

  std::int64_t id;
  Pose T_world_submesh;
  std::vector<MeshVertex> vertices;
};

}  // namespace

FilterView view_of(const Odometry& odometry) {
  const SurfaceMap& map = odometry.map();
  const VisualUpdate* const vision = odometry.vision();
  return {map.empty() ? RigTime() : map.window(map.window_size() - 1).begin(), odometry.state().g,
          vision == nullptr ? SightedImage() : vision->sighted()};
}

MapKeeper::MapKeeper(const Configuration& configuration, const Star& star, BackEndPace pace)
    : config_(configuration.settings.graph),
      pace_(pace),
      feels_gravity_(configuration.sensors.imu),
      cutter_(config_),
      closer_(std::make_unique<LoopCloser>(configuration.settings.loops.by_surfaces)),
      worker_(std::make_unique<GraphWorker>(config_, pace != BackEndPace::within)),
      smooth_(config_.correction_time_s) {
  if (star.antenna_in_body_m) gnss_.emplace(*star.antenna_in_body_m);
  const auto camera = camera_of(configuration.rig, star);
  if (camera && configuration.settings.loops.by_sight)
    sight_.emplace(*camera, configuration.settings.estimator.vision.pixel_sigma_px, capacities::kSightImageBytes);
}

Status MapKeeper::remember(const EarlierMap& earlier) {
  earlier_ = earlier;
  return closer_->remember(earlier.archive, kEarlierMap);
}

void MapKeeper::take(const GnssFix& fix, Duration shift) {
  ++counts_.fixes;
  if (gnss_) gnss_->take(fix, shift);
}

std::optional<KeyFrame> MapKeeper::take(const SweepOutcome& outcome, const FilterView& view) {
  if (previous_ && gnss_) {
    const auto fix =
        gnss_->advance(previous_->stamp, previous_->T_world_body, outcome.stamp, outcome.T_world_body, *cutter_.last());
    if (fix) worker_->post(*fix);
  }
  previous_ = {outcome.stamp, outcome.T_world_body};
  std::optional<Eigen::Vector3d> up_world;
  if (feels_gravity_ && outcome.at_work.imu) up_world = -view.gravity_mps2;
  const auto frame = cutter_.take(outcome, view.sub_mesh_begin, up_world);
  if (frame) {
    corrections_.note_sub_mesh(view.sub_mesh_begin, frame->sub_mesh);
    worker_->post(*frame);
    worker_->post(GraphWorker::Task{[this, noted = *frame](PoseGraph&) { closer_->note(noted); }});
    noted_.push_back(*frame);
  }
  if (sight_) look(frame, view.sighted);
  correct(outcome);
  return frame;
}

// The image is described beside, too: that takes milliseconds.
void MapKeeper::look(const std::optional<KeyFrame>& frame, const SightedImage& sighted) {
  if (frame) sight_->note(*frame);
  auto seen = sight_->take(sighted);
  if (!seen) return;
  if (!find_room(looks_room_)) {
    ++unlooked_;
    return;
  }
  const auto kept = std::make_shared<const SightedKeyFrame>(std::move(*seen));
  worker_->post(GraphWorker::Task{[this, kept](PoseGraph& graph) {
    close(closer_->look(describe(*kept)), graph);
    looks_room_.release();
  }});
}

void MapKeeper::close(const LoopCloser::Closed& closed, PoseGraph& graph) {
  found_.insert(found_.end(), closed.loops.begin(), closed.loops.end());
  for (const LoopMeasurement& loop : closed.loops) graph.add(loop);
  for (const PlaceMeasurement& place : closed.places) graph.add(place);
}

// From one frame to another there is nothing smooth.
void MapKeeper::correct(const SweepOutcome& outcome) {
  const GraphWorker::Whereabouts now = worker_->whereabouts();
  if (now.in_finished_map != in_finished_map_) smooth_ = SmoothCorrection(config_.correction_time_s);
  in_finished_map_ = now.in_finished_map;
  correction_ = smooth_.step(outcome.stamp, outcome.T_world_body, now.T_map_world);
}

std::vector<SubmeshKeyFrame> MapKeeper::key_frames_of(const SubmeshView& sub_mesh) const {
  const auto id = corrections_.sub_mesh_id(sub_mesh.first);
  const Pose T_submesh_world = sub_mesh.T_map_submesh.inverse();
  std::vector<SubmeshKeyFrame> frames;
  for (const KeyFrame& noted : noted_)
    if (noted.sub_mesh == id) frames.push_back({noted.stamp, T_submesh_world * noted.T_world_body});
  return frames;
}

void MapKeeper::take(const SubmeshView& sub_mesh) {
  const auto id = corrections_.sub_mesh_id(sub_mesh.first);
  if (!id) return;
  while (!noted_.empty() && noted_.front().sub_mesh <= *id) noted_.pop_front();
  if (!find_room(room_)) {
    ++unsought_;
    return;
  }
  const auto kept = std::make_shared<const KeptSurface>(sub_mesh);
  worker_->post(GraphWorker::Task{[this, id = *id, kept](PoseGraph& graph) {
    close(closer_->close(id, {kept->id, kept->T_world_submesh, kept->vertices}), graph);
    room_.release();
  }});
}

// For another search.
template <typename Room>
bool MapKeeper::find_room(Room& room) {
  if (pace_ == BackEndPace::live) return room.try_acquire();
  room.acquire();
  return true;
}

void MapKeeper::begin_again() {
  const int map = close();
  closer_->begin_again(worker_->finish(), map);
  cutter_ = KeyFrameCutter(config_);
  if (gnss_) gnss_->begin_again();
  if (sight_) sight_->begin_again();
  worker_ = std::make_unique<GraphWorker>(config_, pace_ != BackEndPace::within);
  smooth_ = SmoothCorrection(config_.correction_time_s);
  previous_.reset();
  noted_.clear();
}

void MapKeeper::finish() {
  close();
  corrections_.set_main(main_map());
}

int MapKeeper::close() {
  const PoseGraph& graph = worker_->finish();
  const int own = kEarlierMap + 1 + static_cast<int>(pieces_.size());
  Piece piece{own, static_cast<std::uint64_t>(graph.size()), graph.places().size(), std::nullopt};
  for (const PlaceMeasurement& place : graph.places()) {
    const RigTime stamp = graph.key_frame(static_cast<int>(place.key_frame)).stamp;
    piece.map = place.map;
    if (!piece.found || stamp < *piece.found) piece.found = stamp;
  }
  pieces_.push_back(piece);
  corrections_.add(graph, piece.map);
  counts_.key_frames += piece.key_frames;
  counts_.loops_accepted += graph.loop_counts().accepted;
  counts_.loops_accepted_by_sight += graph.loop_counts().accepted_by_sight;
  count_rejected(graph);
  note_loops(graph);
  return piece.map;
}

// An earlier session's, if any piece is in it; else that with most of the path.
int MapKeeper::main_map() const {
  std::map<int, std::uint64_t> key_frames;
  for (const Piece& piece : pieces_) key_frames[piece.map] += piece.key_frames;
  if (key_frames.contains(kEarlierMap)) return kEarlierMap;
  return std::ranges::max_element(key_frames, {}, [](const auto& map) { return map.second; })->first;
}

}  // namespace lxd
