// SPDX-License-Identifier: Apache-2.0
#include "board/map_keeper.hpp"

#include <array>

#include "board/real_time_meter.hpp"

namespace lxd {
namespace {

void count(Report::Counts& counts, std::initializer_list<std::pair<const char*, std::uint64_t>> causes) {
  for (const auto& [cause, times] : causes)
    if (times > 0) counts[cause] += times;
}

}  // namespace

FilterView view_of(const Odometry& odometry) {
  const SurfaceMap& map = odometry.map();
  return {map.empty() ? RigTime() : map.window(map.window_size() - 1).begin(), odometry.state().g};
}

MapKeeper::MapKeeper(const Configuration& configuration, const Star& star, bool own_thread)
    : config_(configuration.settings.graph),
      own_thread_(own_thread),
      feels_gravity_(configuration.sensors.imu),
      cutter_(config_),
      closer_(std::make_unique<LoopCloser>()),
      worker_(std::make_unique<GraphWorker>(config_, own_thread)),
      smooth_(config_.correction_time_s) {
  if (star.antenna_in_body_m) gnss_.emplace(*star.antenna_in_body_m);
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
    closer_->note(*frame);
  }
  correction_ = smooth_.step(outcome.stamp, outcome.T_world_body, worker_->T_map_world());
  return frame;
}

void MapKeeper::take(const SubmeshView& sub_mesh) {
  const auto id = corrections_.sub_mesh_id(sub_mesh.first);
  if (!id) return;
  for (const LoopMeasurement& loop : closer_->close(*id, sub_mesh)) worker_->post(loop);
}

void MapKeeper::begin_again() {
  close();
  cutter_ = KeyFrameCutter(config_);
  closer_ = std::make_unique<LoopCloser>();
  if (gnss_) gnss_->begin_again();
  worker_ = std::make_unique<GraphWorker>(config_, own_thread_);
  smooth_ = SmoothCorrection(config_.correction_time_s);
  previous_.reset();
}

void MapKeeper::finish() { close(); }

void MapKeeper::close() {
  const PoseGraph& graph = worker_->finish();
  corrections_.add(graph);
  counts_.key_frames += static_cast<std::uint64_t>(graph.size());
  const LoopCounts loops = graph.loop_counts();
  const LoopCounters& sought = closer_->counters();
  counts_.loops_proposed += sought.proposed;
  counts_.loops_accepted += loops.accepted;
  constexpr std::array<const char*, kLoopVerdicts> kVerdicts{
      "", "little_seen", "little_overlap", "poor_fit", "moved_away", "ambiguous", "open"};
  for (std::size_t i = 1; i < kVerdicts.size(); ++i) count(loops_rejected_, {{kVerdicts[i], sought.verdicts[i]}});
  count(loops_rejected_, {{"surfaces_gone", sought.surfaces_gone},
                          {"not_finite", loops.not_finite},
                          {"unknown_key_frame", loops.unknown_key_frame},
                          {"against_drift", loops.against_drift},
                          {"unseconded", loops.waiting}});
  const GnssCounts gnss = graph.gnss_counts();
  counts_.fixes_used += gnss.used;
  count(fixes_rejected_, {{"not_finite", gnss.not_finite},
                          {"unaligned", gnss.unaligned},
                          {"jumped", gnss.jumped},
                          {"outlying", gnss.outlying}});
}

void MapKeeper::write(Report& report) const {
  report.back_end = counts_;
  report.back_end.key_frame_ms = summarise(worker_->latency());
  for (const auto& [cause, times] : loops_rejected_) report.rejected["loops"][cause] += times;
  for (const auto& [cause, times] : fixes_rejected_) report.rejected["gnss"][cause] += times;
  if (!gnss_) return;
  for (const auto& [cause, times] : gnss_->rejected()) report.rejected["gnss"][cause] += times;
}

}  // namespace lxd
