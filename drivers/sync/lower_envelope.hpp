// SPDX-License-Identifier: Apache-2.0
// The straight line under a cloud of delays: what a sensor's clock differs from the host's when every receive stamp is
// the true one plus a delay that is never negative. drivers/README.md derives it. Fixed memory, no allocation.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "rt/nonblocking.hpp"

namespace lxd {

// value(x) = at_zero + slope * x; x and value in seconds.
struct DelayLine {
  double at_zero_s = 0;
  double slope = 0;

  [[nodiscard]] double at(double x_s) const noexcept LXD_NONBLOCKING { return at_zero_s + slope * x_s; }
};

// Keeps the lowest delay of each of the last kBins bins and lays the line under their lower convex hull.
class LowerEnvelope {
 public:
  static constexpr std::size_t kBins = 64;

  // A slope beyond +-slope_max is not believed.
  LowerEnvelope(double bin_s, double slope_max) : bin_s_(bin_s), slope_max_(slope_max) {}

  // True when the line has changed. A point that is older than the newest bin is left out.
  bool add(double x_s, double delay_s) noexcept LXD_NONBLOCKING;
  // Forgets the delays; the slope stays the first guess for those to come.
  void restart() noexcept LXD_NONBLOCKING { count_ = 0; }

  [[nodiscard]] bool empty() const noexcept LXD_NONBLOCKING { return count_ == 0; }
  // Precondition of the following: not empty().
  [[nodiscard]] const DelayLine& line() const noexcept LXD_NONBLOCKING { return line_; }
  [[nodiscard]] std::size_t bins() const noexcept LXD_NONBLOCKING { return count_; }
  [[nodiscard]] double newest_s() const noexcept LXD_NONBLOCKING { return newest_s_; }
  [[nodiscard]] double span_s() const noexcept LXD_NONBLOCKING { return at(count_ - 1).x_s - at(0).x_s; }
  // Mean height of the bins' lowest delays above the line: how ragged the envelope is.
  [[nodiscard]] double raggedness_s() const noexcept LXD_NONBLOCKING;

 private:
  struct Point {
    double x_s = 0, delay_s = 0;
  };

  [[nodiscard]] const Point& at(std::size_t i) const noexcept LXD_NONBLOCKING { return bins_[(first_ + i) % kBins]; }
  void open_bin(const Point& point) noexcept LXD_NONBLOCKING;
  void fit() noexcept LXD_NONBLOCKING;
  [[nodiscard]] double hull_slope_at_middle() const noexcept LXD_NONBLOCKING;

  double bin_s_, slope_max_;
  std::array<Point, kBins> bins_{};  // a ring; the lowest delay of each bin, in the order of x
  std::size_t first_ = 0, count_ = 0;
  double bin_begin_s_ = 0, newest_s_ = 0;
  DelayLine line_;
};

}  // namespace lxd
