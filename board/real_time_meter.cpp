// SPDX-License-Identifier: Apache-2.0
#include "board/real_time_meter.hpp"

#include <algorithm>

namespace lxd {

LatencySummary summarise(const LatencyHistogram& histogram) {
  constexpr double kMillisecondsPerSecond = 1e3;
  const auto ms = [](Duration d) { return d.seconds() * kMillisecondsPerSecond; };
  return {ms(histogram.mean()), ms(histogram.p50()), ms(histogram.p99()), ms(histogram.max())};
}

RealTimeMeter::Scope::~Scope() {
  const auto elapsed = std::chrono::steady_clock::now() - begin_;
  meter_.allocations_ += allocations_.count() + allocations_.frees();
  meter_.page_faults_ += (thread_page_faults() - faults_).total();
  meter_.cycle_.add(Duration::from_ns(std::chrono::duration_cast<std::chrono::nanoseconds>(elapsed).count()));
}

void RealTimeMeter::add_stage(std::string_view stage, Duration time) {
  const auto found = std::ranges::find(kStages, stage);
  if (found != kStages.end()) stages_[static_cast<std::size_t>(found - kStages.begin())].add(time);
}

void RealTimeMeter::add(const StageTimes& times) {
  add_stage("predict", times.predict);
  add_stage("rotation_guess", times.rotation_guess);
  add_stage("deskew", times.deskew);
  add_stage("downsample", times.downsample);
  add_stage("lidar_update", times.lidar_update);
  add_stage("visual_update", times.visual_update);
  add_stage("raycast", times.raycast);
  add_stage("meshing", times.meshing);
}

void RealTimeMeter::write(Report& report) const {
  report.sweep_ms = summarise(cycle_);
  for (std::size_t i = 0; i < kStages.size(); ++i) report.stages_ms[std::string(kStages[i])] = summarise(stages_[i]);
  if (AllocationGuard::active()) report.rt_allocations = allocations_;
  report.rt_page_faults = page_faults_;
}

}  // namespace lxd
