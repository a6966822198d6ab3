// SPDX-License-Identifier: Apache-2.0
// The watchdog: threads that go round tell so each time; one that does not come back is an event, and so is its return.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "board/event_log.hpp"
#include "rt/time.hpp"

namespace lxd {

enum class WatchedThread : std::uint8_t { input, filter, kCount };

class ThreadWatch {
 public:
  // A round of any of them is over in far less, also on a machine that does other things.
  static constexpr Duration kLongestRound = Duration::from_ns(1'000'000'000);

  explicit ThreadWatch(EventLog& events) : events_(events) {}

  // The watched thread.
  void round(WatchedThread thread, RigTime now) noexcept {
    threads_[static_cast<std::size_t>(thread)].last_ns.store(now.ns(), std::memory_order_relaxed);
  }

  // Another, several times a second, while they run.
  void look(RigTime now) {
    for (std::size_t i = 0; i < threads_.size(); ++i) look(threads_[i], kNames[i], now);
  }
  // How often one was missed.
  [[nodiscard]] std::uint64_t missed() const { return missed_; }

 private:
  static constexpr std::size_t kThreads = static_cast<std::size_t>(WatchedThread::kCount);
  static constexpr std::array<std::string_view, kThreads> kNames{"input thread", "filter thread"};
  struct Thread {
    std::atomic<std::int64_t> last_ns{0};  // 0: it has not begun
    bool away = false;
  };

  void look(Thread& thread, std::string_view name, RigTime now) {
    const std::int64_t last_ns = thread.last_ns.load(std::memory_order_relaxed);
    const bool away = last_ns != 0 && now - RigTime::from_ns(last_ns) > kLongestRound;
    if (away == thread.away) return;
    thread.away = away;
    missed_ += away;
    events_.add(now, std::string(name), away ? "does not come back" : "back");
  }

  std::array<Thread, kThreads> threads_;
  EventLog& events_;
  std::uint64_t missed_ = 0;
};

}  // namespace lxd
