// SPDX-License-Identifier: Apache-2.0
// Tells a clock that has stepped from single stamps that are wrong: a step is several in a row that agree.
#pragma once

#include "rt/nonblocking.hpp"

namespace lxd {

class StepDetector {
 public:
  explicit StepDetector(int pairs) : pairs_(pairs) {}

  // A pair that does not fit the model, by misfit. True: the last ones in a row lie within `spread` of each other; the
  // detector begins anew. Delays that are longer than before may be a queue that empties, and those fall as fast as
  // time goes by: then the row must last longer than such a queue stays within the spread. Delays
  // that also drift, by skew_max at most, may lie as much further apart.
  bool add(double x_s, double delay_s, double misfit_s, double spread_s, double skew_max = 0) noexcept LXD_NONBLOCKING {
    const double apart_s = spread_s + skew_max * (x_s - begin_s_);
    if (count_ == 0 || x_s < begin_s_ || delay_s - low_s_ > apart_s || high_s_ - delay_s > apart_s) {
      begin_s_ = x_s;
      low_s_ = high_s_ = delay_s;
      count_ = 0;
    }
    low_s_ = delay_s < low_s_ ? delay_s : low_s_;
    high_s_ = delay_s > high_s_ ? delay_s : high_s_;
    if (count_ < pairs_) ++count_;
    constexpr double kQueueMargin = 8;  // a serial line that is in use for seven eighths empties no slower
    const bool lasted = misfit_s < 0 || x_s - begin_s_ >= kQueueMargin * spread_s;
    if (count_ < pairs_ || !lasted) return false;
    count_ = 0;
    return true;
  }
  // The lowest delay of the row that made the step.
  [[nodiscard]] double low_s() const noexcept LXD_NONBLOCKING { return low_s_; }
  // A pair that fits.
  void reset() noexcept LXD_NONBLOCKING { count_ = 0; }

 private:
  int pairs_;
  int count_ = 0;
  double begin_s_ = 0, low_s_ = 0, high_s_ = 0;
};

}  // namespace lxd
