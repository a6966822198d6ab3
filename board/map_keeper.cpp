// SPDX-License-Identifier: Apache-2.0
#include "board/map_keeper.hpp"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "board/real_time_meter.hpp"

namespace lxd {
namespace {

void count(Report::Counts& counts, std::initializer_list<std::pair<const char*, std::uint64_t>> causes) {
  for (const auto& [cause, times] : causes)
    if (times > 0) counts[cause] += times;
}

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
  return {map.empty() ? RigTime() : map.window(map.window_size() - 1).begin(), odometry.state().g};
}

MapKeeper::MapKeeper(const Configuration& configuration, const Star& star, BackEndPace pace)
    : config_(configuration.settings.graph),
      pace_(pace),
      feels_gravity_(configuration.sensors.imu),
      cutter_(config_),
      closer_(std::make_unique<LoopCloser>()),
      worker_(std::make_unique<GraphWorker>(config_, pace != BackEndPace::within)),
      smooth_(config_.correction_time_s) {
  if (star.antenna_in_body_m) gnss_.emplace(*star.antenna_in_body_m);
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
  correct(outcome);
  return frame;
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
  if (!find_room()) {
    ++unsought_;
    return;
  }
  const auto kept = std::make_shared<const KeptSurface>(sub_mesh);
  worker_->post(GraphWorker::Task{[this, id = *id, kept](PoseGraph& graph) {
    const LoopCloser::Closed closed = closer_->close(id, {kept->id, kept->T_world_submesh, kept->vertices});
    for (const LoopMeasurement& loop : closed.loops) graph.add(loop);
    for (const PlaceMeasurement& place : closed.places) graph.add(place);
    room_.release();
  }});
}

// For another search.
bool MapKeeper::find_room() {
  if (pace_ == BackEndPace::live) return room_.try_acquire();
  room_.acquire();
  return true;
}

void MapKeeper::begin_again() {
  const int map = close();
  closer_->begin_again(worker_->finish(), map);
  cutter_ = KeyFrameCutter(config_);
  if (gnss_) gnss_->begin_again();
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
  count_rejected(graph);
  return piece.map;
}

void MapKeeper::count_rejected(const PoseGraph& graph) {
  const LoopCounts loops = graph.loop_counts();
  const PlaceCounts places = graph.place_counts();
  count(loops_rejected_, {{"not_finite", loops.not_finite},
                          {"unknown_key_frame", loops.unknown_key_frame + places.not_sound},
                          {"against_drift", loops.against_drift},
                          {"unseconded", loops.waiting + places.waiting}});
  const GnssCounts gnss = graph.gnss_counts();
  counts_.fixes_used += gnss.used;
  count(fixes_rejected_, {{"not_finite", gnss.not_finite},
                          {"unaligned", gnss.unaligned},
                          {"jumped", gnss.jumped},
                          {"outlying", gnss.outlying}});
}

// An earlier session's, if any piece is in it; else that with most of the path.
int MapKeeper::main_map() const {
  std::map<int, std::uint64_t> key_frames;
  for (const Piece& piece : pieces_) key_frames[piece.map] += piece.key_frames;
  if (key_frames.contains(kEarlierMap)) return kEarlierMap;
  return std::ranges::max_element(key_frames, {}, [](const auto& map) { return map.second; })->first;
}

void MapKeeper::write_map(Report& report) const {
  const int main = main_map();
  MapReport& map = report.map;
  map.pieces = pieces_.size();
  for (const Piece& piece : pieces_) {
    map.pieces_apart += piece.map != main && piece.key_frames > 0;
    map.places += piece.places;
    if (piece.map == kEarlierMap && !map.relocalised_t_s) map.relocalised_t_s = piece.found->seconds();
  }
  if (map.pieces_apart > 0)
    report.hints.push_back(
        fmt::format("the filter began again {} times, and {} of the pieces were never found in the others: they are in "
                    "map.db, each in a frame of its own, and not in the mesh, the cloud and the trajectory",
                    map.pieces - 1, map.pieces_apart));
  if (!earlier_) return;
  map.earlier = earlier_->file.string();
  map.localise = earlier_->localise;
  if (!map.relocalised_t_s)
    report.hints.push_back(fmt::format("never found in {}: this run has a frame of its own, and nothing was merged",
                                       earlier_->file.string()));
}

void MapKeeper::write(Report& report) const {
  report.back_end = counts_;
  report.back_end.key_frame_ms = summarise(worker_->latency());
  const LoopCounters& sought = closer_->counters();
  report.back_end.loops_proposed = sought.proposed;
  constexpr std::array<const char*, kLoopVerdicts> kVerdicts{
      "", "little_seen", "little_overlap", "poor_fit", "moved_away", "ambiguous", "open"};
  for (std::size_t i = 1; i < kVerdicts.size(); ++i)
    count(report.rejected["loops"], {{kVerdicts[i], sought.verdicts[i]}});
  count(report.rejected["loops"], {{"surfaces_gone", sought.surfaces_gone}, {"unsought_sub_mesh", unsought_}});
  if (report.rejected["loops"].empty()) report.rejected.erase("loops");
  write_map(report);
  for (const auto& [cause, times] : loops_rejected_) report.rejected["loops"][cause] += times;
  for (const auto& [cause, times] : fixes_rejected_) report.rejected["gnss"][cause] += times;
  if (!gnss_) return;
  for (const auto& [cause, times] : gnss_->rejected()) report.rejected["gnss"][cause] += times;
}

}  // namespace lxd
