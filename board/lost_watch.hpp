// SPDX-License-Identifier: Apache-2.0
// When the filter is lost for good: for so long no pose was held by anything but the prediction.
#pragma once

#include <optional>

#include "estimator/sweep_outcome.hpp"

namespace lxd {

class LostWatch {
 public:
  // 0: never.
  explicit LostWatch(double after_s) : after_s_(after_s) {}

  // Of each sweep that was taken, in order: time to begin again.
  bool lost(const SweepOutcome& outcome) {
    if (!held_ || outcome.tracked || outcome.carried) held_ = outcome.stamp;
    return after_s_ > 0 && (outcome.stamp - *held_).seconds() >= after_s_;
  }
  void begin_again() { held_.reset(); }

 private:
  double after_s_;
  std::optional<RigTime> held_;  // last, or begun
};

}  // namespace lxd
