// SPDX-License-Identifier: Apache-2.0
// When to look again for a device that is away: soon, then less and less often.
#pragma once

#include <algorithm>

#include "rt/time.hpp"

namespace lxd {

class Reopening {
 public:
  static constexpr Duration kFirst = Duration::from_ns(100'000'000);
  static constexpr Duration kLongest = Duration::from_ns(500'000'000);  // a filter waits for who comes back

  [[nodiscard]] bool due(RigTime now) const { return now >= next_; }
  void failed(RigTime now) {
    next_ = now + wait_;
    wait_ = std::min(wait_ * 2, kLongest);
  }
  // Bytes came: the next departure is a new one.
  void works() { wait_ = kFirst; }

 private:
  RigTime next_ = kNever;
  Duration wait_ = kFirst;
};

}  // namespace lxd
