// SPDX-License-Identifier: Apache-2.0
// Hands the sweeps of a recording to the estimator's thread, in order: read in turn, or read ahead on a thread of its
// own. Either way the estimator sees the same sweeps, so the result is the same; only a paced replay drops.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <optional>
#include <semaphore>
#include <thread>

#include "board/default/capacities.hpp"
#include "board/pacer.hpp"
#include "drivers/replay/source.hpp"
#include "rt/spsc_ring.hpp"
#include "rt/sweep_pool.hpp"

namespace lxd {

// All calls from the estimator's thread.
class SweepFeed {
 public:
  virtual ~SweepFeed() = default;
  // Waits for the next sweep. Nothing: the recording has ended, or status() says why nothing more can be read.
  virtual std::optional<SweepIndex> next() = 0;
  // Of a sweep that next() gave.
  virtual void give_back(SweepIndex index) = 0;
  // Final once next() gave nothing.
  [[nodiscard]] virtual const Status& status() const = 0;
  // Sweeps that were passed over because newer ones were waiting.
  [[nodiscard]] virtual std::uint64_t late() const = 0;
};

class DirectFeed final : public SweepFeed {
 public:
  // Both must outlive the feed.
  DirectFeed(SweepSource& source, SweepPool& pool) : source_(source), pool_(pool) {}

  std::optional<SweepIndex> next() override;
  void give_back(SweepIndex index) override { pool_.release(index); }
  [[nodiscard]] const Status& status() const override { return status_; }
  [[nodiscard]] std::uint64_t late() const override { return 0; }

 private:
  SweepSource& source_;
  SweepPool& pool_;
  Status status_ = success();
};

// Paced: a sweep is handed over when its last point would have been measured, and the newest one wins. Not paced:
// reading waits when all buffers are full, nothing is dropped.
class AheadFeed final : public SweepFeed {
 public:
  // Once `stop` is true, next() waits for nothing more.
  AheadFeed(SweepSource& source, SweepPool& pool, bool paced, const std::atomic<bool>& stop);
  ~AheadFeed() override;
  AheadFeed(const AheadFeed&) = delete;
  AheadFeed& operator=(const AheadFeed&) = delete;

  std::optional<SweepIndex> next() override;
  void give_back(SweepIndex index) override;
  [[nodiscard]] const Status& status() const override { return status_; }
  [[nodiscard]] std::uint64_t late() const override { return late_; }

 private:
  void read_ahead();                // reader's thread
  bool read_one(SweepIndex index);  // reader's thread; false at the end
  SweepIndex newest_of(SweepIndex index);

  SweepSource& source_;
  SweepPool& pool_;
  bool paced_;
  const std::atomic<bool>& stop_;
  Pacer pacer_;                                                                 // reader's thread
  std::array<SweepIndex, std::bit_ceil(capacities::kSweepsInFlight)> slots_{};  // of the ring
  SpscRing<SweepIndex> ring_;                                                   // reader to estimator
  std::counting_semaphore<> free_;                                              // buffers that may be filled
  std::counting_semaphore<> ready_{0};  // sweeps in the ring, and one for its end
  std::optional<SweepIndex> in_hand_;   // the reader's, until it has ended
  std::atomic<bool> stopping_{false};
  Status status_ = success();  // written by the reader before its last release of ready_
  std::uint64_t late_ = 0;
  std::thread reader_;  // last: starts when all else is there
};

}  // namespace lxd
