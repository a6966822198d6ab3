// SPDX-License-Identifier: Apache-2.0
// What the tests in the guest have of the outside: commands of the guest's shell, and a loop that drives devices as a
// board's I/O thread does.
#pragma once

#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>

#include "drivers/device/device.hpp"
#include "drivers/device/host_clock.hpp"
#include "tests/hil/can_sender.hpp"

namespace lxd::hil {

inline void shell(const std::string& command) { EXPECT_EQ(std::system(command.c_str()), 0) << command; }

// What a device gave.
struct Kept final : ChunkSink {
  void take(const Chunk& chunk) override {
    stamps.push_back(chunk.received);
    contents.emplace_back(chunk.bytes.begin(), chunk.bytes.end());
    bytes += chunk.bytes.size();
  }
  std::vector<RigTime> stamps;
  std::vector<std::vector<std::uint8_t>> contents;
  std::size_t bytes = 0;
};

struct Driven {
  Device* device = nullptr;
  ChunkSink* sink = nullptr;
};

// Until `done`, or the patience is over; false then.
inline bool drive(const std::vector<Driven>& devices, const HostClock& clock, const std::function<bool()>& done,
                  double patience_s = 30) {
  constexpr int kWait_ms = 50;
  const RigTime end = clock.now() + Duration::from_seconds(patience_s);
  while (!done() && clock.now() < end) {
    std::vector<pollfd> wanted;
    for (const Driven& each : devices) {
      each.device->tend(clock.now());
      wanted.push_back({each.device->fd(), POLLIN, 0});
    }
    ::poll(wanted.data(), wanted.size(), kWait_ms);
    for (std::size_t i = 0; i < devices.size(); ++i) {
      if (wanted[i].revents != 0) devices[i].device->read(*devices[i].sink);
    }
  }
  return done();
}

}  // namespace lxd::hil
