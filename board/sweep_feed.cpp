// SPDX-License-Identifier: Apache-2.0
#include "board/sweep_feed.hpp"

namespace lxd {
namespace {

constexpr std::chrono::milliseconds kStopPeriod{50};  // between looks at `stop` while a recording has a gap

}  // namespace

std::optional<SweepIndex> DirectFeed::next() {
  const auto index = pool_.acquire();
  if (!index) return std::nullopt;
  const Result<bool> more = source_.next(pool_[*index]);
  if (more.ok() && *more) return index;
  if (!more) status_ = more.error();
  pool_.release(*index);
  return std::nullopt;
}

AheadFeed::AheadFeed(SweepSource& source, SweepPool& pool, bool paced, const std::atomic<bool>& stop)
    : source_(source), pool_(pool), paced_(paced), stop_(stop), ring_(slots_), free_(pool.capacity()), reader_([this] {
        read_ahead();
      }) {}

AheadFeed::~AheadFeed() {
  stopping_ = true;
  free_.release();
  reader_.join();
  // Another feed may follow on the same pool.
  while (const auto index = ring_.pop()) pool_.release(*index);
  if (in_hand_) pool_.release(*in_hand_);
}

void AheadFeed::read_ahead() {
  for (;;) {
    free_.acquire();
    if (stopping_) break;
    in_hand_ = pool_.acquire();
    if (!in_hand_ || !read_one(*in_hand_)) break;
    (void)ring_.push(*in_hand_);  // has as many slots as there are buffers
    in_hand_.reset();
    ready_.release();
  }
  ready_.release();
}

// Runs into the end of the recording with a buffer in hand: giving it back is the estimator's part.
bool AheadFeed::read_one(SweepIndex index) {
  const Result<bool> more = source_.next(pool_[index]);
  if (!more) status_ = more.error();
  if (!more || !*more) return false;
  if (paced_) pacer_.wait_until(pool_[index].end, stopping_);
  return true;
}

std::optional<SweepIndex> AheadFeed::next() {
  while (!ready_.try_acquire_for(kStopPeriod))
    if (stop_) return std::nullopt;
  const auto oldest = ring_.pop();
  if (!oldest) {
    ready_.release();  // the end stays the end, however often it is asked for
    return std::nullopt;
  }
  return paced_ ? newest_of(*oldest) : *oldest;
}

SweepIndex AheadFeed::newest_of(SweepIndex index) {
  while (ready_.try_acquire()) {
    const auto newer = ring_.pop();
    if (!newer) {
      ready_.release();
      break;
    }
    give_back(index);
    ++late_;
    index = *newer;
  }
  return index;
}

void AheadFeed::give_back(SweepIndex index) {
  pool_.release(index);
  free_.release();
}

}  // namespace lxd
