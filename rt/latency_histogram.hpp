// SPDX-License-Identifier: Apache-2.0
// Latencies in fixed memory: buckets that grow with the value (as HdrHistogram's), so that a quantile is right to 1.6 %
// from 1 ns to 18 minutes. Belongs to one thread; another may read it when that one rests.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "rt/nonblocking.hpp"
#include "rt/time.hpp"

namespace lxd {

class LatencyHistogram {
 public:
  // A quantile is the middle of its bucket; a bucket is at most 1/32 of its lower edge wide.
  static constexpr double kRelativeError = 1.0 / 64;
  // Larger values share the last bucket (mean and max stay exact).
  static constexpr std::int64_t kLargest_ns = (std::int64_t{1} << 40) - 1;

  // A negative latency counts as 0.
  void add(Duration latency) noexcept LXD_NONBLOCKING {
    const std::int64_t ns = std::max<std::int64_t>(latency.ns(), 0);
    ++buckets_[bucket(std::min(ns, kLargest_ns))];
    ++count_;
    sum_ns_ += static_cast<double>(ns);
    max_ns_ = std::max(max_ns_, ns);
  }

  [[nodiscard]] std::uint64_t count() const noexcept LXD_NONBLOCKING { return count_; }
  // Exact but for rounding; 0 when nothing was added.
  [[nodiscard]] Duration mean() const noexcept LXD_NONBLOCKING {
    if (count_ == 0) return Duration{};
    return Duration::from_ns(static_cast<std::int64_t>(sum_ns_ / static_cast<double>(count_)));
  }
  // Exact.
  [[nodiscard]] Duration max() const noexcept LXD_NONBLOCKING { return Duration::from_ns(max_ns_); }

  // The smallest latency that a share q in [0, 1] of all values does not exceed (nearest rank), within kRelativeError;
  // never above max(); 0 when nothing was added.
  [[nodiscard]] Duration quantile(double q) const noexcept LXD_NONBLOCKING {
    const auto rank =
        std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(count_))));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      seen += buckets_[i];
      if (seen >= rank) return Duration::from_ns(std::min(middle_ns(i), max_ns_));
    }
    return max();
  }
  [[nodiscard]] Duration p50() const noexcept LXD_NONBLOCKING { return quantile(0.50); }
  [[nodiscard]] Duration p99() const noexcept LXD_NONBLOCKING { return quantile(0.99); }

 private:
  static constexpr int kSubBits = 5;  // 32 buckets an octave; values below 32 ns have one each
  static constexpr std::int64_t kSub = std::int64_t{1} << kSubBits;
  static constexpr int kOctaves = 40 - kSubBits;
  static constexpr std::size_t kBuckets = kSub * (kOctaves + 1);

  // The top kSubBits + 1 bits of ns; octave o covers [32, 64) << o.
  static constexpr std::size_t bucket(std::int64_t ns) noexcept LXD_NONBLOCKING {
    if (ns < kSub) return static_cast<std::size_t>(ns);
    const int octave = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(ns))) - 1 - kSubBits;
    return static_cast<std::size_t>(kSub * octave + (ns >> octave));
  }

  static constexpr std::int64_t middle_ns(std::size_t index) noexcept LXD_NONBLOCKING {
    const auto i = static_cast<std::int64_t>(index);
    if (i < 2 * kSub) return i;
    const std::int64_t octave = i / kSub - 1;
    const std::int64_t lower = (i - kSub * octave) << octave;
    return lower + (std::int64_t{1} << octave) / 2;
  }

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  double sum_ns_ = 0;  // exact up to 2^53 ns, 104 days of latency; rounds after that instead of wrapping
  std::int64_t max_ns_ = 0;
};

}  // namespace lxd
