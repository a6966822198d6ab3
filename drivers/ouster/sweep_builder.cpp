// SPDX-License-Identifier: Apache-2.0
// See sweep_builder.hpp.
#include "drivers/ouster/sweep_builder.hpp"

#include <algorithm>
#include <limits>

namespace lxd {
namespace {

// A turn takes at most 0.2 s (4096x5); a column further than this from the frame's median has a damaged stamp, which
// LEGACY packets, having no check value, cannot show otherwise.
constexpr std::uint64_t kFarthestFromMedian_ns = kNanosPerSecond / 4;
constexpr std::uint64_t kLatestTime_ns = 1ULL << 62U;  // year 2116; sums and differences below it cannot overflow

}  // namespace

OusterSweepBuilder::OusterSweepBuilder(const OusterMetadata& metadata)
    : table_(metadata), rows_(metadata.format.pixels_per_column) {
  times_.reserve(metadata.columns_per_frame);
}

bool OusterSweepBuilder::build(const OusterFrame& frame, Sweep& sweep) {
  sweep.count = 0;
  if (frame.columns_present == 0) return false;
  median_ns_ = median_time_ns(frame);
  const TimeSpan span = sound_span(frame);
  add_returns(frame, {frame.range_mm, frame.reflectivity, counts_.no_return}, span.first_ns, sweep);
  if (!frame.range2_mm.empty()) {
    const std::uint32_t first_returns = sweep.count;
    std::uint64_t no_second = 0;
    add_returns(frame, {frame.range2_mm, frame.reflectivity2, no_second}, span.first_ns, sweep);
    counts_.second_returns += sweep.count - first_returns;
  }
  sweep.begin = RigTime::from_ns(span.first_ns);
  sweep.end = sweep.stamp = RigTime::from_ns(span.last_ns);
  return sweep.count > 0;
}

std::int64_t OusterSweepBuilder::median_time_ns(const OusterFrame& frame) {
  times_.clear();
  for (std::size_t column = 0; column < frame.present.size(); ++column) {
    if (frame.present[column] != 0) times_.push_back(static_cast<std::int64_t>(frame.timestamp_ns[column]));
  }
  const auto middle = times_.begin() + static_cast<std::ptrdiff_t>(times_.size() / 2);
  std::nth_element(times_.begin(), middle, times_.end());
  return *middle;
}

bool OusterSweepBuilder::sound_time(const OusterFrame& frame, std::size_t column) const {
  // Unsigned, so that any 64 bits may be subtracted.
  const std::uint64_t median = static_cast<std::uint64_t>(median_ns_);
  const std::uint64_t time = frame.timestamp_ns[column];
  return time < kLatestTime_ns && std::min(time - median, median - time) <= kFarthestFromMedian_ns;
}

OusterSweepBuilder::TimeSpan OusterSweepBuilder::sound_span(const OusterFrame& frame) {
  TimeSpan span{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()};
  for (std::size_t column = 0; column < frame.present.size(); ++column) {
    if (frame.present[column] == 0) continue;
    if (!sound_time(frame, column)) {
      ++counts_.bad_column_time;
      continue;
    }
    const auto time_ns = static_cast<std::int64_t>(frame.timestamp_ns[column]);
    span.first_ns = std::min(span.first_ns, time_ns);
    span.last_ns = std::max(span.last_ns, time_ns);
  }
  return span;
}

void OusterSweepBuilder::add_returns(const OusterFrame& frame, const Returns& returns, std::int64_t begin_ns,
                                     Sweep& sweep) {
  for (std::size_t column = 0; column < frame.present.size(); ++column) {
    if (frame.present[column] == 0 || !sound_time(frame, column)) continue;
    const std::int64_t offset_ns = static_cast<std::int64_t>(frame.timestamp_ns[column]) - begin_ns;
    add_column(returns, column, static_cast<std::uint32_t>(offset_ns), sweep);
  }
}

void OusterSweepBuilder::add_column(const Returns& returns, std::size_t column, std::uint32_t offset_ns, Sweep& sweep) {
  for (std::size_t pixel = column * rows_; pixel < (column + 1) * rows_; ++pixel) {
    if (returns.range_mm[pixel] == 0) {
      ++returns.none;
      continue;
    }
    const Eigen::Vector3f p = table_.point(pixel, returns.range_mm[pixel]);
    const bool kept = sweep.push({p.x(), p.y(), p.z(), static_cast<float>(returns.reflectivity[pixel]), offset_ns});
    if (!kept) ++counts_.above_capacity;
  }
}

}  // namespace lxd
