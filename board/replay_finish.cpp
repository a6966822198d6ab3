// SPDX-License-Identifier: Apache-2.0
// What a replay tells of itself: on the way, and in the end.
#include "board/core_report.hpp"
#include "board/recorded_sensors.hpp"
#include "board/replay_system.hpp"

namespace lxd {

Status ReplaySystem::finish() {
  const SurfaceMap& map = core_.odometry().map();
  Status first = collect_window();
  if (map.lost_sub_meshes() > 0) report_.dropped["sub_meshes"] = map.lost_sub_meshes();
  keeper_.finish();
  keep_first(first, output_->finish_map(keeper_.corrections()));
  meter_.write(report_);
  count_rejections();
  keep_first(first, count_other_sensors());
  report_.hints = streams_.hints();
  add_calibration(core_.odometry(), star_, report_);
  keeper_.write(report_);
  output_->write(report_);
  add_surprise(report_);
  report_.peak_rss_mib = peak_rss_mib();
  keep_first(first, output_->write_report(report_));
  return first;
}

void ReplaySystem::count_rejections() {
  for (const auto& [cause, times] : source_->rejected()) report_.rejected[source_->kind()][cause] += times;
}

Status ReplaySystem::count_other_sensors() {
  const auto rejected = read_recorded_sensors(recording_, configuration_.rig, {});
  if (!rejected) return rejected.error();
  for (const auto& [sensor, causes] : *rejected) report_.rejected[sensor] = causes;
  for (const auto& [sensor, causes] : streams_.rejected(core_.odometry())) {
    for (const auto& [cause, times] : causes) report_.rejected[sensor][cause] += times;
  }
  return success();
}

bool ReplaySystem::wants_more() const {
  const int limit = configuration_.settings.replay.sweeps;
  return limit == 0 || loop_sweeps_ < static_cast<std::uint64_t>(limit);
}

ReplayProgress ReplaySystem::progress(const SweepFeed& feed) {
  ReplayProgress progress;
  progress.sweeps = report_.sweeps;
  if (const auto size = source_->size()) progress.total = *size * configuration_.settings.replay.loops;
  progress.dropped = late_ + feed.late() + report_.sweeps - output_->poses().size();
  progress.untracked = report_.updates.untracked;
  progress.recorded_s = (end_ - *begin_).seconds();
  progress.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  if (!written_ && !told_) progress.unwritten = written_.error().message;
  told_ = !written_;
  return progress;
}

}  // namespace lxd
