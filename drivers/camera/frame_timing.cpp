// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/frame_timing.hpp"

#include <algorithm>

namespace lxd {

std::optional<FrameStamp> find_frame_stamp(std::string_view name) {
  const auto found = std::ranges::find(kFrameStampNames, name);
  if (found == kFrameStampNames.end()) return std::nullopt;
  return static_cast<FrameStamp>(found - kFrameStampNames.begin());
}

RigTime ExposureTiming::begin(RigTime frame_stamp, bool says_start) const {
  const bool driver = stamp == FrameStamp::driver || stamp == FrameStamp::trigger;
  const bool at_start = driver ? says_start : stamp == FrameStamp::exposure_start;
  return at_start ? frame_stamp : frame_stamp - readout - exposure;
}

std::optional<RigTime> FrameClock::instant(RigTime begin, Duration exposure, RigTime stamp, RigTime now) {
  const RigTime by_itself = begin + exposure / 2;
  if (!matcher_) return by_itself;
  const TriggerMatch match = matcher_->match(stamp, now);
  if (match.verdict == TriggerVerdict::wait) return std::nullopt;
  return match.verdict == TriggerVerdict::matched ? match.instant : by_itself;
}

void count_triggers(const FrameClock& clock, Rejections& rejected) {
  const TriggerCounts counts = clock.counts();
  count_rejected(rejected, "frame_without_trigger", counts.frames_without_trigger);
  count_rejected(rejected, "ambiguous_trigger", counts.ambiguous);
  count_rejected(rejected, "trigger_without_frame", counts.triggers_without_frame);
  count_rejected(rejected, "trigger_backwards", counts.disordered);
}

}  // namespace lxd
