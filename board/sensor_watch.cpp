// SPDX-License-Identifier: Apache-2.0
#include "board/sensor_watch.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lxd {
namespace {

constexpr double kSilentPeriods = 5;
constexpr double kPulseRate_hz = 1;

}  // namespace

SensorWatch::SensorWatch(const LiveRig& live, EventLog& events) : events_(events) {
  const Rig& rig = live.rig;
  use(LiveChannel::lidar0, rig.lidar0.rate_hz);
  if (live.sensors.extra_lidar) use(LiveChannel::lidar1, rig.lidar1->rate_hz);
  if (live.sensors.imu && !live.uses_lidar_imu()) use(LiveChannel::imu, rig.imu->update_rate);
  if (live.sensors.wheel) use(LiveChannel::wheel, rig.wheel->rate_hz);
  if (live.sensors.gnss) use(LiveChannel::gnss, rig.gnss->rate_hz);
  if (live.sensors.camera) use(LiveChannel::camera0, rig.camera0->rate_hz);
  if (live.pulse) use(LiveChannel::pps, kPulseRate_hz);
  if (live.triggers && rig.camera0) use(LiveChannel::triggers, rig.camera0->rate_hz);
}

void SensorWatch::use(LiveChannel channel, double rate_hz) {
  Sensor& sensor = sensors_[index_of(channel)];
  sensor.used = true;
  sensor.silence = std::max(kShortestSilence, Duration::from_seconds(kSilentPeriods / rate_hz));
}

void SensorWatch::look(RigTime now) {
  for (std::size_t i = 0; i < kLiveChannels; ++i)
    if (sensors_[i].used) look(channel_at(i), now);
}

void SensorWatch::look(LiveChannel channel, RigTime now) {
  Sensor& sensor = sensors_[index_of(channel)];
  const std::int64_t last_ns = sensor.last_ns.load(std::memory_order_relaxed);
  if (last_ns == kNotYet) return;
  const RigTime last = RigTime::from_ns(last_ns);
  const bool alive = now - last <= sensor.silence;
  if (alive == sensor.alive) return;
  sensor.alive = alive;
  const std::string name(name_of(channel));
  if (!alive) return events_.add(last, name, "silent");
  events_.add(last, name, sensor.begun ? "heard again" : "heard");
  sensor.begun = true;
}

std::string SensorWatch::silent() const {
  std::string names;
  for (std::size_t i = 0; i < kLiveChannels; ++i) {
    if (!sensors_[i].used || sensors_[i].alive) continue;
    if (!names.empty()) names += ", ";
    names += kLiveChannelNames[i];
  }
  return names;
}

}  // namespace lxd
