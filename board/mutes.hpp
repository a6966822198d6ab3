// SPDX-License-Identifier: Apache-2.0
// Sensors that a replay shall not hear for a while, as if unplugged: what a rig does without them can be tried on any
// recording.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

struct Mute {
  std::string sensor;            // lidar0 lidar1 camera0 imu wheel gnss
  Duration begin;                // since the first sweep's begin
  std::optional<Duration> span;  // none: for good
};

// SENSOR@BEGIN[+DURATION], seconds, e.g. "imu@10+0.5". The error names the text and what is wrong with it.
Result<Mute> parse_mute(std::string_view text);

// All of them; the first error.
Result<std::vector<Mute>> parse_mutes(std::span<const std::string> texts);

class Mutes {
 public:
  Mutes() = default;
  explicit Mutes(std::vector<Mute> mutes) : mutes_(std::move(mutes)) {}

  // Times are counted from here; nothing is muted before it is told.
  void begin(RigTime zero) {
    if (!zero_) zero_ = zero;
  }
  [[nodiscard]] bool silent(std::string_view sensor, RigTime t) const;

 private:
  std::vector<Mute> mutes_;
  std::optional<RigTime> zero_;
};

}  // namespace lxd
