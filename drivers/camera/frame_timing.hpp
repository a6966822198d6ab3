// SPDX-License-Identifier: Apache-2.0
// Of which instant an image is: the middle of its exposure, told by the kernel's stamp of its frame or by the edge that
// triggered it. The same object below a recorded camera and below a live one.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/replay/rejections.hpp"
#include "drivers/sync/trigger_matcher.hpp"
#include "rt/time.hpp"

namespace lxd {

enum class FrameStamp : std::uint8_t {
  driver,          // as the driver says: start of exposure or end of frame
  exposure_start,  // whatever it says
  frame_end,
  trigger  // the trigger's edge; of a frame without one, as the driver says
};
inline constexpr std::array<std::string_view, 4> kFrameStampNames{"driver", "exposure_start", "frame_end", "trigger"};
// None: not one of these.
std::optional<FrameStamp> find_frame_stamp(std::string_view name);

// When the exposure began of a frame with the kernel's `stamp`. `says_start`: that is of its start, the driver says.
struct ExposureTiming {
  FrameStamp stamp = FrameStamp::driver;
  Duration exposure;  // zero: not known
  Duration readout;   // from the exposure's end to a stamp at the frame's end

  [[nodiscard]] RigTime begin(RigTime frame_stamp, bool says_start) const;
};

class FrameClock {
 public:
  // By the exposures themselves, or by their triggers.
  FrameClock() = default;
  explicit FrameClock(const TriggerTiming& timing) : matcher_(timing) {}

  [[nodiscard]] bool by_triggers() const { return matcher_.has_value(); }
  void add_trigger(RigTime edge) {
    if (matcher_) matcher_->add_trigger(edge);
  }

  // The middle of the exposure that began at `begin`, of the frame with the kernel's `stamp`. None: its trigger may
  // still come; ask again. Frames in their order.
  [[nodiscard]] std::optional<RigTime> instant(RigTime begin, Duration exposure, RigTime stamp, RigTime now);

  // matched, frames_without_trigger and so on; zeros without triggers.
  [[nodiscard]] TriggerCounts counts() const { return matcher_ ? matcher_->counts() : TriggerCounts(); }

 private:
  std::optional<TriggerMatcher> matcher_;
};

// frame_without_trigger, ambiguous_trigger, trigger_without_frame, trigger_backwards.
void count_triggers(const FrameClock& clock, Rejections& rejected);

}  // namespace lxd
