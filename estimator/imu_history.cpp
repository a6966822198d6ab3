// SPDX-License-Identifier: Apache-2.0
#include "estimator/imu_history.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

bool is_finite(const InertialReading& r) { return r.rate_radps.allFinite() && r.force_mps2.allFinite(); }

bool same_values(const InertialReading& a, const InertialReading& b) {
  return a.rate_radps == b.rate_radps && a.force_mps2 == b.force_mps2;
}

InertialSpan between(const InertialReading& a, const InertialReading& b) {
  return {(b.t - a.t).seconds(), 0.5 * (a.rate_radps + b.rate_radps), 0.5 * (a.force_mps2 + b.force_mps2),
          b.rate_radps - a.rate_radps, b.force_mps2 - a.force_mps2};
}

}  // namespace

ImuHistory::ImuHistory(Arena& arena)
    : readings_(arena.take<InertialReading>("inertial readings", kReadings)),
      spans_(arena.take<InertialSpan>("inertial spans", kSpansMax)) {}

void ImuHistory::add(const InertialReading& reading) noexcept {
  if (!is_finite(reading)) {
    ++counts_.not_finite;
    return;
  }
  if (count_ > 0 && reading.t <= newest().t) {
    ++counts_.late;
    return;
  }
  repeats_ = count_ > 0 && same_values(reading, newest()) ? repeats_ + 1 : 0;
  if (repeats_ >= kStuckReadings) {
    ++counts_.stuck;
    return;
  }
  if (count_ == kReadings) {
    first_ = (first_ + 1) % kReadings;
    --count_;
  }
  readings_[(first_ + count_++) % kReadings] = reading;
}

std::uint32_t ImuHistory::until(RigTime t) const noexcept {
  std::uint32_t low = 0, high = count_;
  while (low < high) {
    const std::uint32_t middle = (low + high) / 2;
    if (at(middle).t <= t)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

bool ImuHistory::covers(RigTime from, RigTime to, Duration gap_max) const noexcept {
  from = from + delay_;
  to = to + delay_;
  const std::uint32_t before = until(from);
  if (before == 0) return false;
  RigTime last = at(before - 1).t;
  for (std::uint32_t i = before; i < count_ && last < to; ++i) {
    if (at(i).t - last > gap_max) return false;
    last = at(i).t;
  }
  return to - last <= gap_max && until(to) - before + 2 <= kSpansMax;
}

InertialReading ImuHistory::value_at(RigTime t) const noexcept {
  InertialReading out = stamped(t + delay_);
  out.t = t;
  return out;
}

InertialReading ImuHistory::stamped(RigTime stamp) const noexcept {
  const std::uint32_t after = until(stamp);
  InertialReading out = at(after == 0 ? 0 : after - 1);
  if (after > 0 && after < count_) {
    const InertialReading& next = at(after);
    const double part = (stamp - out.t).seconds() / (next.t - out.t).seconds();
    out.rate_radps += part * (next.rate_radps - out.rate_radps);
    out.force_mps2 += part * (next.force_mps2 - out.force_mps2);
  }
  out.t = stamp;
  return out;
}

std::span<const InertialSpan> ImuHistory::spans(RigTime from, RigTime to) noexcept {
  from = from + delay_;
  to = to + delay_;
  std::size_t count = 0;
  InertialReading begin = stamped(from);
  for (std::uint32_t i = until(from); i < count_ && at(i).t < to && count + 1 < spans_.size(); ++i) {
    spans_[count++] = between(begin, at(i));
    begin = at(i);
  }
  if (begin.t < to) spans_[count++] = between(begin, stamped(to));
  return spans_.first(count);
}

ImuHistory::Mean ImuHistory::mean(RigTime from, RigTime to) const noexcept {
  Mean m;
  from = from + delay_;
  to = to + delay_;
  const std::uint32_t begin = from > RigTime() ? until(from - Duration::from_ns(1)) : 0, end = until(to);
  for (std::uint32_t i = begin; i < end; ++i) {
    m.rate_radps += at(i).rate_radps;
    m.force_mps2 += at(i).force_mps2;
  }
  m.count = end - begin;
  if (m.count == 0) return m;
  m.rate_radps /= m.count;
  m.force_mps2 /= m.count;
  for (std::uint32_t i = begin; i < end; ++i) {
    m.rate_sigma += (at(i).rate_radps - m.rate_radps).squaredNorm();
    m.force_sigma += (at(i).force_mps2 - m.force_mps2).squaredNorm();
  }
  m.rate_sigma = std::sqrt(m.rate_sigma / (3.0 * m.count));
  m.force_sigma = std::sqrt(m.force_sigma / (3.0 * m.count));
  return m;
}

}  // namespace lxd
