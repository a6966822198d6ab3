// SPDX-License-Identifier: Apache-2.0
#include "board/tracking_log.hpp"

namespace lxd {
namespace {

constexpr const char* kPrediction = "none";  // what carries the pose when no sensor does: its own motion
constexpr Duration kSilence = Duration::from_ns(500'000'000);  // without a pose: nothing worked meanwhile

}  // namespace

std::string TrackingLog::all_of(SensorSet sensors) {
  sensors.gnss = false;
  return text_of(sensors);
}

std::string TrackingLog::working(const SweepOutcome& outcome) const {
  SensorSet at_work = sensors_;
  at_work.gnss = false;
  at_work.extra_lidar = outcome.at_work.extra_lidar;
  at_work.camera = outcome.at_work.camera;
  at_work.imu = outcome.at_work.imu;
  at_work.wheel = outcome.at_work.wheel;
  const std::string text = text_of(at_work);
  if (outcome.at_work.primary_lidar) return text;
  return text.size() > 1 ? text.substr(1) : kPrediction;
}

void TrackingLog::note(const SweepOutcome& outcome, Report& report) {
  if (first_) {
    first_ = false;
    last_ = outcome.stamp;
    return;
  }
  report.updates.not_finite = outcome.not_finite_updates;
  report.updates.carried += outcome.carried;
  report.updates.over_budget += outcome.over_budget;
  report.updates.untracked += !outcome.tracked && !outcome.carried;
  report.updates.degenerate += outcome.tracked && outcome.degenerate_directions > 0;
  report.updates.nis += outcome.innovation.squared;
  report.updates.nis_dimensions += static_cast<std::uint64_t>(outcome.innovation.dimensions);
  if (last_ && outcome.stamp - *last_ > kSilence) change(kPrediction, *last_, report);
  last_ = outcome.stamp;
  change(working(outcome), outcome.stamp, report);
}

void TrackingLog::change(const std::string& now, RigTime t, Report& report) {
  if (now == working_) return;
  report.degraded.push_back({working_, now, t.seconds()});
  working_ = now;
}

}  // namespace lxd
