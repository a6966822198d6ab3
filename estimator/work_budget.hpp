// SPDX-License-Identifier: Apache-2.0
// Overload: a sweep that must be done within a budget of wall time is given fewer iterations, and the sweeps after it
// fewer points, until they fit again. No sweep is skipped for it. Without a budget nothing depends on the wall clock,
// so that a replay stays deterministic. Real-time thread only.
#pragma once

#include <algorithm>

#include "rt/stopwatch.hpp"

namespace lxd {

class WorkBudget {
 public:
  static constexpr double kPointsMin = 0.25;  // share of the points wanted, at least

  // Nothing or less: no budget.
  explicit WorkBudget(Duration budget) : budget_(budget) {}

  void begin() noexcept LXD_NONBLOCKING { begin_ = Stopwatch(); }

  // May another iteration begin? The map's part of a sweep needs time as well.
  [[nodiscard]] bool allows_iteration() const noexcept LXD_NONBLOCKING {
    return !limited() || begin_.elapsed().seconds() < kUpdateShare * budget_.seconds();
  }

  // Of the points wanted for the next sweep.
  [[nodiscard]] double points_share() const { return share_; }

  // The sweep is done; true: it took longer than it may.
  bool end() noexcept LXD_NONBLOCKING { return limited() && took(begin_.elapsed()); }

  // What end() makes of the time taken.
  bool took(Duration time) noexcept LXD_NONBLOCKING {
    const double load = time.seconds() / budget_.seconds();
    if (load > 1) share_ = std::max(kPointsMin, share_ * kLess);
    if (load < kIdleLoad) share_ = std::min(1.0, share_ * kMore);
    return load > 1;
  }

 private:
  static constexpr double kUpdateShare = 0.6;        // of the budget, for all before the map
  static constexpr double kLess = 0.7, kMore = 1.1;  // points of the next sweep to this one's
  static constexpr double kIdleLoad = 0.7;           // below, there is room for more points

  [[nodiscard]] bool limited() const { return budget_.ns() > 0; }

  Duration budget_;
  Stopwatch begin_;
  double share_ = 1;
};

}  // namespace lxd
