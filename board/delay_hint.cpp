// SPDX-License-Identifier: Apache-2.0
#include "board/delay_hint.hpp"

#include <cmath>

#include <fmt/format.h>

namespace lxd {
namespace {

// Clocks without a pulse differ by a few milliseconds; more, and surely so, is worth being said in the rig file.
constexpr double kDelay_s = 0.004, kDelaySigmas = 5;

}  // namespace

void DelayHint::note(double delay_s, double sigma_s) {
  if (!said_s_) said_s_ = delay_s;
  found_s_ = delay_s;
  sigma_s_ = sigma_s;
}

std::string DelayHint::sentence(std::string_view sensor, std::string_view samples) const {
  if (!said_s_) return {};
  const double off_s = std::abs(found_s_ - *said_s_);
  if (off_s < kDelay_s || off_s < kDelaySigmas * sigma_s_) return {};
  return fmt::format(
      "{0}: its {1} are stamped {2:.1f} ms later than the LiDAR's returns, {3:.1f} ms by the rig file: put "
      "{0}.delay_s: {4:.4f} there",
      sensor, samples, 1e3 * found_s_, 1e3 * *said_s_, found_s_);
}

}  // namespace lxd
