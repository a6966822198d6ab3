// SPDX-License-Identifier: Apache-2.0
// The rig's clock on a live rig. Its zero is 1970, as CLOCK_REALTIME had it when this object was made; from then on it
// goes by CLOCK_MONOTONIC, so that setting the host's clock (NTP, a user, a GNSS receiver) moves no sample. The kernel
// stamps datagrams, frames and pulses by CLOCK_REALTIME, images by CLOCK_MONOTONIC: both come onto the rig's clock
// here.
#pragma once

#include <cstdint>

#include "rt/time.hpp"

namespace lxd {

// Any thread; all of one rig share one object.
class HostClock {
 public:
  // An older stamp than this, or one of the future, was made before the host's clock was set: now is taken instead.
  static constexpr Duration kOldestStamp = Duration::from_ns(10'000'000'000);

  HostClock();

  [[nodiscard]] RigTime now() const;
  [[nodiscard]] RigTime of_monotonic(std::int64_t stamp_ns) const;
  // By its age at this moment, so whatever the host's clock was set to before does not matter. Never later than now().
  [[nodiscard]] RigTime of_realtime(std::int64_t stamp_ns) const;

  // How far the host's clock has been set since the start: CLOCK_REALTIME minus the rig's.
  [[nodiscard]] Duration host_ahead() const;

 private:
  std::int64_t rig_minus_monotonic_ns_ = 0;
};

}  // namespace lxd
