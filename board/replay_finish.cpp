// SPDX-License-Identifier: Apache-2.0
// What a replay tells of itself: on the way, and in the end.
#include "board/core_report.hpp"
#include "board/recorded_sensors.hpp"
#include "board/replay_system.hpp"

namespace lxd {

Status ReplaySystem::finish() {
  Status first = writer_.store_last_window(core_.odometry().map());
  keep_first(first, writer_.finish_map());
  fill_report(writer_.report());
  keep_first(first, count_other_sensors());
  keep_first(first, writer_.write_report());
  return first;
}

void ReplaySystem::fill_report(Report& report) {
  report.sweeps = counted_.sweeps;
  report.pools = counted_.pools;
  report.threads = realtime_ ? 3 : configuration_.settings.threads;  // reading, filter, and the one that writes
  for (const auto& [cause, times] : counted_.dropped) report.dropped[cause] += times;
  if (late_ > 0) report.dropped["late"] = late_;
  const std::uint64_t lost = core_.odometry().map().lost_sub_meshes();
  if (lost > 0) report.dropped["sub_meshes"] = lost;
  meter_.write(report);
  count_rejections();
  report.hints = streams_.hints();
  add_calibration(core_.odometry(), star_, report);
  report.peak_rss_mib = peak_rss_mib();
}

void ReplaySystem::count_rejections() {
  for (const auto& [cause, times] : source_->rejected()) writer_.report().rejected[source_->kind()][cause] += times;
}

Status ReplaySystem::count_other_sensors() {
  const auto rejected = read_recorded_sensors(recording_, configuration_.rig, {});
  if (!rejected) return rejected.error();
  Report& report = writer_.report();
  for (const auto& [sensor, causes] : *rejected) report.rejected[sensor] = causes;
  for (const auto& [sensor, causes] : streams_.rejected(core_.odometry())) {
    for (const auto& [cause, times] : causes) report.rejected[sensor][cause] += times;
  }
  return success();
}

bool ReplaySystem::wants_more() const {
  const int limit = configuration_.settings.replay.sweeps;
  return limit == 0 || loop_sweeps_ < static_cast<std::uint64_t>(limit);
}

void ReplaySystem::tell(const ReplayObserver& observe, const SweepFeed& feed) {
  ReplayProgress progress;
  progress.sweeps = counted_.sweeps;
  if (const auto size = source_->size()) progress.total = *size * configuration_.settings.replay.loops;
  progress.dropped = late_ + feed.late();
  for (const auto& [cause, times] : counted_.dropped) progress.dropped += times;
  progress.recorded_s = (end_ - *begin_).seconds();
  progress.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  write([this, progress, &observe]() mutable {
    progress.untracked = writer_.report().updates.untracked;
    if (!written_ && !told_) progress.unwritten = written_.error().message;
    told_ = !written_;
    observe(progress);
  });
}

}  // namespace lxd
