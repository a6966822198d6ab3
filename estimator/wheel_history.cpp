// SPDX-License-Identifier: Apache-2.0
#include "estimator/wheel_history.hpp"

#include <algorithm>

namespace lxd {
namespace {

constexpr Duration kWheelHole =
    Duration::from_ns(150'000'000);  // between two readings: what was rolled then is a guess

// Between a and b, at t.
WheelReading between(const WheelReading& a, const WheelReading& b, RigTime t) {
  const double part = (t - a.t).seconds() / (b.t - a.t).seconds();
  return {t, a.speed_mps + part * (b.speed_mps - a.speed_mps),
          a.yaw_rate_radps + part * (b.yaw_rate_radps - a.yaw_rate_radps)};
}

void roll(const WheelReading& a, const WheelReading& b, WheelWay& way) {
  const double dt_s = (b.t - a.t).seconds();
  way.way_m += dt_s * (a.speed_mps + b.speed_mps) / 2;
  way.turn_rad += dt_s * (a.yaw_rate_radps + b.yaw_rate_radps) / 2;
  way.speed_change_mps += b.speed_mps - a.speed_mps;
  way.rate_change_radps += b.yaw_rate_radps - a.yaw_rate_radps;
  way.span_s += dt_s;
  ++way.readings;
}

}  // namespace

void WheelHistory::add(const WheelReading& reading) noexcept {
  if (!std::isfinite(reading.speed_mps) || !std::isfinite(reading.yaw_rate_radps)) return;
  if (count_ > 0 && reading.t <= at(1).t) return;
  readings_[count_++ % kReadings] = reading;
}

std::uint32_t WheelHistory::since(RigTime after) const noexcept {
  std::uint32_t back = 0;
  const auto kept = static_cast<std::uint32_t>(std::min<std::uint64_t>(count_, kReadings));
  while (back < kept && at(back + 1).t > after + delay_) ++back;
  return back;
}

std::optional<WheelWay> WheelHistory::way(RigTime from, RigTime to) const noexcept {
  const std::uint32_t later = since(from);
  if (later == 0 || later == std::min<std::uint64_t>(count_, kReadings) || !(from < to)) return std::nullopt;
  WheelWay way;
  WheelReading last = at(later + 1);
  last.t = last.t - delay_;
  bool begun = false, whole = true;
  for_each(from, [&](const WheelReading& next) {
    whole = whole && next.t - last.t <= kWheelHole;
    const WheelReading begin = begun ? last : between(last, next, from);
    roll(begin, next.t < to ? next : between(last, next, to), way);
    begun = true;
    last = next;
    return next.t < to;
  });
  if (!whole || last.t < to) return std::nullopt;
  return way;
}

}  // namespace lxd
