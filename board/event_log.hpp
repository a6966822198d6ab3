// SPDX-License-Identifier: Apache-2.0
// What happened to a live rig and when: a cable pulled, a sensor silent, heard again. Bounded; any thread but the
// real-time one, since it locks and allocates.
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "rt/time.hpp"

namespace lxd {

struct RigEvent {
  RigTime t;
  std::string source;  // a sensor, or a device's name
  std::string what;
};

class EventLog {
 public:
  static constexpr std::size_t kEventsMax = 1000;  // later ones are only counted

  void add(RigTime t, std::string source, std::string what) {
    const std::scoped_lock lock(mutex_);
    if (events_.size() < kEventsMax)
      events_.push_back({t, std::move(source), std::move(what)});
    else
      ++left_out_;
  }

  // A copy of those after the first `seen`.
  [[nodiscard]] std::vector<RigEvent> after(std::size_t seen) const {
    const std::scoped_lock lock(mutex_);
    return {events_.begin() + static_cast<std::ptrdiff_t>(std::min(seen, events_.size())), events_.end()};
  }
  [[nodiscard]] std::uint64_t left_out() const {
    const std::scoped_lock lock(mutex_);
    return left_out_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<RigEvent> events_;
  std::uint64_t left_out_ = 0;
};

}  // namespace lxd
