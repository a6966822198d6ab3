// SPDX-License-Identifier: Apache-2.0
#include "board/signal_devices.hpp"

#include "drivers/camera/v4l2_camera.hpp"
#include "drivers/sync/gpio_edges.hpp"
#include "drivers/sync/pps_device.hpp"

namespace lxd {
namespace {

// A camera that is triggered has its triggers' rate.
VideoConfig video_of(const CameraRig& rig) {
  VideoConfig config;
  config.path = rig.wire.device;
  config.fourcc = fourcc_of_format(rig.wire.pixel_format).value_or(0);
  config.width = rig.resolution[0];
  config.height = rig.resolution[1];
  if (!rig.wire.by_triggers()) config.rate_hz = rig.rate_hz;
  if (rig.wire.exposure_s > 0) config.exposure_s = rig.wire.exposure_s;
  config.controls = rig.wire.controls;
  return config;
}

std::unique_ptr<Device> line_of(const GpioWire& wire, LiveChannel channel, const HostClock& clock,
                                const LiveKernel& kernel) {
  return std::make_unique<GpioEdges>(GpioConfig{wire.chip, wire.line.value_or(0), number_of(channel)}, clock,
                                     kernel.gpio());
}

std::unique_ptr<Device> pulse_of(const PulseRig& rig, const HostClock& clock, const LiveKernel& kernel) {
  if (rig.device.empty()) return line_of(rig.gpio, LiveChannel::pps, clock, kernel);
  const auto edge = rig.edge == "clear" ? PpsSource::Edge::clear : PpsSource::Edge::assert;
  return std::make_unique<PpsDevice>(rig.device, edge, number_of(LiveChannel::pps), clock, *kernel.calls);
}

}  // namespace

void open_signals(const LiveRig& live, const HostClock& clock, const LiveKernel& kernel, LiveDevices& opened) {
  const Rig& rig = live.rig;
  if (live.pulse) opened.devices.push_back(pulse_of(*rig.pps, clock, kernel));
  if (live.triggers) opened.devices.push_back(line_of(rig.triggers->camera0, LiveChannel::triggers, clock, kernel));
  if (live.sensors.camera)
    opened.camera =
        std::make_unique<V4l2Camera>(video_of(*rig.camera0), number_of(LiveChannel::camera0), clock, *kernel.calls);
}

}  // namespace lxd
