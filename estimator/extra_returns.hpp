// SPDX-License-Identifier: Apache-2.0
// What the extra LiDAR has fired since the last sweep of the primary one, in whatever pieces it came. It has no map of
// its own: its returns join the primary's next sweep, each at its own time. Memory from the arena.
#pragma once

#include <cstdint>
#include <span>

#include "rt/arena.hpp"
#include "rt/sweep.hpp"
#include "rt/time.hpp"

namespace lxd {

class ExtraReturns {
 public:
  static constexpr Duration kSpanMax = Duration::from_ns(250'000'000);  // older returns are of another sweep

  ExtraReturns(Arena& arena, std::size_t capacity) : storage_(arena.take<LidarPoint>("extra returns", capacity)) {}

  // A return, its offset counted from `zero`. What has no room, or is older than the first one, is counted and lost;
  // one much later than the first begins anew.
  void add(RigTime zero, const LidarPoint& point) noexcept;
  void clear() { count_ = 0; }

  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] RigTime begin() const { return begin_; }  // offset 0
  [[nodiscard]] std::span<const LidarPoint> points() const { return storage_.first(count_); }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  std::span<LidarPoint> storage_;
  std::size_t count_ = 0;
  RigTime begin_;
  std::uint64_t lost_ = 0;
};

}  // namespace lxd
