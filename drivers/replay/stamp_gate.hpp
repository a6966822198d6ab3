// SPDX-License-Identifier: Apache-2.0
// Lets sweeps pass only in the order of time: the estimator cannot go back.
#pragma once

#include <optional>

#include "drivers/replay/rejections.hpp"
#include "rt/time.hpp"

namespace lxd {

class StampGate {
 public:
  // False, and counted: no stamp, the last accepted stamp again, or an earlier one.
  bool admit(std::optional<RigTime> stamp, Rejections& rejected) {
    const char* const cause = fault(stamp);
    if (cause != nullptr) count_rejected(rejected, cause);
    if (cause == nullptr) last_ = stamp;
    return cause == nullptr;
  }

 private:
  [[nodiscard]] const char* fault(std::optional<RigTime> stamp) const {
    if (!stamp) return "time_missing";
    if (last_ && *stamp == *last_) return "time_repeated";
    if (last_ && *stamp < *last_) return "time_backwards";
    return nullptr;
  }
  std::optional<RigTime> last_;
};

}  // namespace lxd
