// SPDX-License-Identifier: Apache-2.0
// Proves the real-time path: around each cycle it measures the time, the allocations and the page faults of the calling
// thread. Belongs to that thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "board/report.hpp"
#include "estimator/sweep_outcome.hpp"
#include "rt/allocation_guard.hpp"
#include "rt/latency_histogram.hpp"
#include "rt/page_faults.hpp"

namespace lxd {

LatencySummary summarise(const LatencyHistogram& histogram);

class RealTimeMeter {
 public:
  // Runs one cycle and returns what it returns.
  template <typename Cycle>
  decltype(auto) measure(Cycle&& cycle) {
    const Scope scope(*this);
    return cycle();
  }

  // Of the cycle that was just measured.
  void add(const StageTimes& times);

  // Fills sweep_ms, stages_ms, rt_allocations, rt_page_faults.
  void write(Report& report) const;

 private:
  void add_stage(std::string_view stage, Duration time);  // one of kStages

  class Scope {
   public:
    explicit Scope(RealTimeMeter& meter) : meter_(meter) {}
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope();

   private:
    RealTimeMeter& meter_;
    PageFaults faults_ = thread_page_faults();
    AllocationGuard allocations_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  };

  LatencyHistogram cycle_;
  std::array<LatencyHistogram, kStages.size()> stages_;
  std::uint64_t allocations_ = 0;
  std::uint64_t page_faults_ = 0;
};

}  // namespace lxd
