// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/frame_plan.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/simulator/camera/camera_faults.hpp"
#include "tools/simulator/camera/exposure_control.hpp"
#include "tools/simulator/camera/renderer.hpp"

namespace lxd::sim {
namespace {

// Since the recording's start. A last exposure has room for its whole period.
std::vector<double> begins_s(const Context& context, const CameraConfig& config) {
  double first_s = 0, period_s = 1 / config.rate_hz;
  if (config.trigger == CameraTrigger::kSync) {
    const double into_second_s = static_cast<double>(context.start.ns() % kNanosPerSecond) * 1e-9;
    first_s = std::ceil(into_second_s * config.rate_hz) * period_s - into_second_s;
  } else {
    constexpr double kPpm = 1e-6;
    period_s /= 1 + config.clock.skew_ppm * kPpm;
    first_s = Random(context.seed, config.name + " phase").uniform(0, period_s);
  }
  std::vector<double> begins;
  for (int k = 0; first_s + (k + 1) * period_s <= context.duration_s; ++k) begins.push_back(first_s + k * period_s);
  return begins;
}

// One frame after the other, for the exposure of one depends on those before it.
class Planner {
 public:
  Planner(const Context& context, const CameraConfig& config)
      : context_(context),
        config_(config),
        table_(config),
        renderer_(context.scene, config, table_),
        control_(config),
        clock_(config.clock, context.start) {}

  void add(double begin_s) {
    Random random(context_.seed, config_.name + " frames", plan_.log.triggered);
    Frame frame{plan_.log.triggered++, begin_s, exposure(begin_s), 0, false, 0, RigTime()};
    const bool dropped = happens(kCameraDrop, begin_s, random);
    frame.corrupt = happens(kCameraCorrupt, begin_s, random);
    frame.stamp_ns = clock_.stamped_ns(context_.rig_time(begin_s), random);
    const RigTime received = clock_.received(context_.rig_time(begin_s + frame.exposure.duration_s), random);
    if (context_.faults.active(kCameraUnplugged, begin_s)) {
      ++plan_.log.unplugged;
      sequence_ = 0;
      return;
    }
    frame.sequence = sequence_++;
    if (dropped) {
      ++plan_.log.dropped;
      return;
    }
    frame.received = last_received_ = std::max(received, last_received_);  // one cable: frames do not overtake
    deliver(frame);
  }

  [[nodiscard]] FramePlan plan() const { return plan_; }

 private:
  bool happens(std::string_view fault, double t_s, Random& random) const {
    const double draw = random.uniform();
    const Fault* const active = context_.faults.active(fault, t_s);
    return active && draw < active->value;
  }

  Exposure exposure(double begin_s) {
    const Pose T_world_camera =
        context_.motion.at(last_begin_s_.value_or(begin_s)).T_world_body * config_.T_body_sensor;
    const double metered =
        config_.auto_exposure ? renderer_.metered(T_world_camera, last_begin_s_.value_or(begin_s)) : 0;
    last_begin_s_ = begin_s;
    const Exposure exposure = control_.next(metered);
    const Fault* const jump = context_.faults.active(kCameraExposureJump, begin_s);
    return jump ? control_.brighter(exposure, jump->value) : exposure;
  }

  void deliver(const Frame& frame) {
    plan_.frames.push_back(frame);
    ++plan_.log.delivered;
    if (frame.corrupt) ++plan_.log.corrupt;
    if (context_.faults.active(kCameraExposureJump, frame.begin_s)) ++plan_.log.jumped;
  }

  const Context& context_;
  const CameraConfig& config_;
  RayTable table_;
  Renderer renderer_;
  ExposureControl control_;
  SensorClock clock_;
  FramePlan plan_;
  std::uint32_t sequence_ = 0;
  std::optional<double> last_begin_s_;
  RigTime last_received_;
};

}  // namespace

std::vector<RigTime> exposure_times(const Context& context, const CameraConfig& config) {
  std::vector<RigTime> times;
  for (const double begin_s : begins_s(context, config)) times.push_back(context.rig_time(begin_s));
  return times;
}

Result<FramePlan> plan_frames(const Context& context, const CameraConfig& config) {
  Planner planner(context, config);
  for (const double begin_s : begins_s(context, config)) planner.add(begin_s);
  FramePlan plan = planner.plan();
  for (const Frame& frame : plan.frames) {
    if (frame.stamp_ns < 0)
      return Error{
          fmt::format("{}: its clock's offset makes the stamp of exposure {} negative, wanted a smaller offset",
                      config.name, frame.trigger)};
  }
  return plan;
}

}  // namespace lxd::sim
