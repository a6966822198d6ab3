// SPDX-License-Identifier: Apache-2.0
// Everything of a camera's frames but their pixels: when they are exposed and how long, which of them arrive, what the
// driver says of them. Planned before the first is rendered, so that frames may be rendered in any order.
#pragma once

#include <cstdint>
#include <vector>

#include "rt/result.hpp"
#include "tools/simulator/camera/camera_config.hpp"
#include "tools/simulator/camera/sensor_response.hpp"
#include "tools/simulator/context.hpp"

namespace lxd::sim {

// Exposures of the recording, by what became of them.
struct CameraLog {
  std::uint64_t triggered = 0;  // all; delivered, dropped and unplugged are its parts
  std::uint64_t delivered = 0;
  std::uint64_t dropped = 0;    // lost on the way: the sequence has a gap
  std::uint64_t unplugged = 0;  // no camera there: the sequence begins again afterwards
  std::uint64_t corrupt = 0;    // of the delivered
  std::uint64_t jumped = 0;     // of the delivered: wrongly exposed
};

struct Frame {
  std::uint64_t trigger = 0;  // number of the exposure, those of lost frames counted
  double begin_s = 0;         // of the exposure: true, since the recording's start
  Exposure exposure;
  std::uint32_t sequence = 0;  // the driver's
  bool corrupt = false;        // and flagged so
  std::int64_t stamp_ns = 0;   // the exposure's begin on the camera's clock
  RigTime received;            // at the host, after the exposure's end
};

struct FramePlan {
  std::vector<Frame> frames;  // those that arrive
  CameraLog log;
};

// When exposures begin, in true rig time: the edges of the trigger line, also of frames that are lost later.
std::vector<RigTime> exposure_times(const Context& context, const CameraConfig& config);

// Errors: a clock whose stamps are negative.
Result<FramePlan> plan_frames(const Context& context, const CameraConfig& config);

}  // namespace lxd::sim
