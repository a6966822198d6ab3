// SPDX-License-Identifier: Apache-2.0
// Which sensors of a live rig are heard: begun, silent for too long, heard again. What is heard is told by the thread
// that reads; looking is another's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "board/event_log.hpp"
#include "board/live_rig.hpp"

namespace lxd {

class SensorWatch {
 public:
  // A sensor is silent after this long, or five of its periods if that is longer.
  static constexpr Duration kShortestSilence = Duration::from_ns(200'000'000);

  SensorWatch(const LiveRig& live, EventLog& events);

  // The reading thread: bytes came that belong to the sensor.
  void heard(LiveChannel channel, RigTime t) {
    sensors_[index_of(channel)].last_ns.store(t.ns(), std::memory_order_relaxed);
  }

  // The looking thread, several times a second.
  void look(RigTime now);
  // The looking thread. Whether it was heard, and is not silent.
  [[nodiscard]] bool alive(LiveChannel channel) const { return sensors_[index_of(channel)].alive; }
  // The looking thread: names of the sensors in use that are not alive, parted by commas.
  [[nodiscard]] std::string silent() const;

 private:
  static constexpr std::int64_t kNotYet = INT64_MIN;
  struct Sensor {
    bool used = false;
    bool alive = false, begun = false;
    Duration silence;
    std::atomic<std::int64_t> last_ns{kNotYet};
  };
  void use(LiveChannel channel, double rate_hz);
  void look(LiveChannel channel, RigTime now);

  std::array<Sensor, kLiveChannels> sensors_;
  EventLog& events_;
};

}  // namespace lxd
