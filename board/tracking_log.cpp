// SPDX-License-Identifier: Apache-2.0
#include "board/tracking_log.hpp"

namespace lxd {

void TrackingLog::note(const SweepOutcome& outcome, Report& report) {
  if (first_) {
    first_ = false;
    return;
  }
  report.updates.not_finite = outcome.not_finite_updates;
  report.updates.untracked += !outcome.tracked;
  report.updates.degenerate += outcome.tracked && outcome.degenerate_directions > 0;
  report.updates.nis += outcome.innovation.squared;
  report.updates.nis_dimensions += static_cast<std::uint64_t>(outcome.innovation.dimensions);
  if (outcome.tracked == tracked_) return;
  tracked_ = outcome.tracked;
  const double t_s = outcome.stamp.seconds();
  report.degraded.push_back(tracked_ ? Degradation{kPrediction, sensors_, t_s}
                                     : Degradation{sensors_, kPrediction, t_s});
}

}  // namespace lxd
