// SPDX-License-Identifier: Apache-2.0
// The one clock of a rig: int64 nanoseconds, as types of their own, so that a time is never taken for a span.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>

namespace lxd {

inline constexpr std::int64_t kNanosPerSecond = 1'000'000'000;

// A signed span of time.
class Duration {
 public:
  constexpr Duration() = default;
  static constexpr Duration from_ns(std::int64_t ns) { return Duration(ns); }
  // Rounds to the nearest nanosecond; |s| must be below 292 years.
  static Duration from_seconds(double s) { return Duration(std::llround(s * 1e9)); }

  [[nodiscard]] constexpr std::int64_t ns() const { return ns_; }
  [[nodiscard]] constexpr double seconds() const { return static_cast<double>(ns_) * 1e-9; }

  constexpr auto operator<=>(const Duration&) const = default;
  constexpr Duration operator+(Duration o) const { return Duration(ns_ + o.ns_); }
  constexpr Duration operator-(Duration o) const { return Duration(ns_ - o.ns_); }
  constexpr Duration operator-() const { return Duration(-ns_); }
  constexpr Duration operator*(std::int64_t k) const { return Duration(ns_ * k); }
  constexpr Duration operator/(std::int64_t k) const { return Duration(ns_ / k); }

 private:
  constexpr explicit Duration(std::int64_t ns) : ns_(ns) {}
  std::int64_t ns_ = 0;
};

// A point on the rig's clock. Its zero is the source's: a recording says which.
class RigTime {
 public:
  constexpr RigTime() = default;
  static constexpr RigTime from_ns(std::int64_t ns) { return RigTime(ns); }
  static RigTime from_seconds(double s) { return RigTime(std::llround(s * 1e9)); }

  [[nodiscard]] constexpr std::int64_t ns() const { return ns_; }
  [[nodiscard]] constexpr double seconds() const { return static_cast<double>(ns_) * 1e-9; }

  constexpr auto operator<=>(const RigTime&) const = default;
  constexpr RigTime operator+(Duration d) const { return RigTime(ns_ + d.ns()); }
  constexpr RigTime operator-(Duration d) const { return RigTime(ns_ - d.ns()); }
  constexpr Duration operator-(RigTime o) const { return Duration::from_ns(ns_ - o.ns_); }

 private:
  constexpr explicit RigTime(std::int64_t ns) : ns_(ns) {}
  std::int64_t ns_ = 0;
};

// Before every recording; far enough from the type's end that spans since then are sound.
inline constexpr RigTime kNever = RigTime::from_ns(std::numeric_limits<std::int64_t>::min() / 4);

}  // namespace lxd
