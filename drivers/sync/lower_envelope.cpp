// SPDX-License-Identifier: Apache-2.0
// See lower_envelope.hpp.
#include "drivers/sync/lower_envelope.hpp"

#include <algorithm>
#include <limits>

namespace lxd {

bool LowerEnvelope::add(double x_s, double delay_s) noexcept LXD_NONBLOCKING {
  const Point point{x_s, delay_s};
  if (count_ == 0 || x_s >= bin_begin_s_ + bin_s_) {
    open_bin(point);
    fit();
    return true;
  }
  if (x_s < bin_begin_s_) return false;
  newest_s_ = std::max(newest_s_, x_s);
  Point& lowest = bins_[(first_ + count_ - 1) % kBins];
  if (delay_s - line_.at(x_s) >= lowest.delay_s - line_.at(lowest.x_s)) return false;
  lowest = point;
  fit();
  return true;
}

void LowerEnvelope::open_bin(const Point& point) noexcept LXD_NONBLOCKING {
  const double oldest_s = point.x_s - static_cast<double>(kBins) * bin_s_;
  while (count_ > 0 && (count_ == kBins || at(0).x_s < oldest_s)) {
    first_ = (first_ + 1) % kBins;
    --count_;
  }
  bins_[(first_ + count_) % kBins] = point;
  ++count_;
  bin_begin_s_ = newest_s_ = point.x_s;
}

// Once the slope is known, the line is as high as the lowest point over it allows.
void LowerEnvelope::fit() noexcept LXD_NONBLOCKING {
  if (count_ > 1) line_.slope = std::clamp(hull_slope_at_middle(), -slope_max_, slope_max_);
  line_.at_zero_s = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count_; ++i)
    line_.at_zero_s = std::min(line_.at_zero_s, at(i).delay_s - line_.slope * at(i).x_s);
}

// Of all lines under the points the one that is closest to them in the mean touches the hull's edge over the mean of x.
// Andrew's monotone chain, lower half.
double LowerEnvelope::hull_slope_at_middle() const noexcept LXD_NONBLOCKING {
  std::array<Point, kBins> hull;
  std::size_t size = 0;
  double mean_s = 0;
  const auto slope = [](const Point& a, const Point& b) { return (b.delay_s - a.delay_s) / (b.x_s - a.x_s); };
  for (std::size_t i = 0; i < count_; ++i) {
    mean_s += at(i).x_s / static_cast<double>(count_);
    while (size >= 2 && slope(hull[size - 2], hull[size - 1]) >= slope(hull[size - 1], at(i))) --size;
    hull[size++] = at(i);
  }
  std::size_t right = 1;
  while (right + 1 < size && hull[right].x_s < mean_s) ++right;
  return slope(hull[right - 1], hull[right]);
}

double LowerEnvelope::raggedness_s() const noexcept LXD_NONBLOCKING {
  double sum_s = 0;
  for (std::size_t i = 0; i < count_; ++i) sum_s += std::max(0.0, at(i).delay_s - line_.at(at(i).x_s));
  return sum_s / static_cast<double>(count_);
}

}  // namespace lxd
