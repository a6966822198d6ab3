// SPDX-License-Identifier: Apache-2.0
#include "board/io_loop.hpp"

#include <utility>

#include <fmt/format.h>

namespace lxd {

IoLoop::IoLoop(std::vector<std::unique_ptr<Device>> devices, const HostClock& clock, EventLog& events)
    : devices_(std::move(devices)),
      polled_(devices_.size()),
      troubles_(devices_.size()),
      clock_(clock),
      events_(events) {}

std::vector<std::unique_ptr<Device>> IoLoop::of(std::unique_ptr<Device> device) {
  std::vector<std::unique_ptr<Device>> one;
  one.push_back(std::move(device));
  return one;
}

void IoLoop::turn(ChunkSink& sink, int wait_ms) {
  const RigTime now = clock_.now();
  if (now >= next_tend_) tend(now);
  for (std::size_t i = 0; i < devices_.size(); ++i) polled_[i] = {devices_[i]->fd(), POLLIN, 0};
  if (::poll(polled_.data(), polled_.size(), wait_ms) <= 0) return;
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (polled_[i].revents == 0) continue;
    devices_[i]->read(sink);
    note(i, now);
  }
}

void IoLoop::drain(ChunkSink& sink, int turns) {
  for (int i = 0; i < turns; ++i) turn(sink, 0);
}

void IoLoop::tend(RigTime now) {
  next_tend_ = now + kTendPeriod;
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    devices_[i]->tend(now);
    note(i, now);
  }
}

// A device that is there from the start is no event.
void IoLoop::note(std::size_t i, RigTime now) {
  const std::string& trouble = devices_[i]->trouble();
  if (trouble == troubles_[i]) return;
  troubles_[i] = trouble;
  events_.add(now, devices_[i]->name(), trouble.empty() ? "back" : fmt::format("away: {}", trouble));
}

std::map<std::string, std::map<std::string, std::uint64_t>> IoLoop::counts() const {
  std::map<std::string, std::map<std::string, std::uint64_t>> all;
  for (const auto& device : devices_) {
    auto& counts = all[device->name()];
    for (const auto& [name, count] : kDeviceCountNames)
      if (device->counts().*count > 0) counts[name] = device->counts().*count;
    device->add_counts(counts);
  }
  return all;
}

}  // namespace lxd
