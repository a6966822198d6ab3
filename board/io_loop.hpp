// SPDX-License-Identifier: Apache-2.0
// Drives all devices of a rig from one thread: waits until one of them has bytes, hands them on, looks for those that
// are away.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <poll.h>

#include "board/event_log.hpp"
#include "drivers/device/device.hpp"
#include "drivers/device/host_clock.hpp"

namespace lxd {

class IoLoop {
 public:
  static constexpr Duration kTendPeriod = Duration::from_ns(100'000'000);
  static constexpr int kLongestWait_ms = 20;

  // `clock` and `events` outlive the loop.
  IoLoop(std::vector<std::unique_ptr<Device>> devices, const HostClock& clock, EventLog& events);

  static std::vector<std::unique_ptr<Device>> of(std::unique_ptr<Device> device);

  // Waits for bytes, not longer than `wait_ms`, and hands over what there is.
  void turn(ChunkSink& sink, int wait_ms = kLongestWait_ms);
  // Hands over what waits in the kernel, and no more than `turns` times what one turn gives.
  void drain(ChunkSink& sink, int turns);

  // When no turn is under way: what each device counted, by its name and by cause.
  [[nodiscard]] std::map<std::string, std::map<std::string, std::uint64_t>> counts() const;

 private:
  void tend(RigTime now);
  void note(std::size_t i, RigTime now);

  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<pollfd> polled_;         // as the devices
  std::vector<std::string> troubles_;  // as they were told last
  const HostClock& clock_;
  EventLog& events_;
  RigTime next_tend_ = kNever;
};

}  // namespace lxd
