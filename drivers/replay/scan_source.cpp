// SPDX-License-Identifier: Apache-2.0
// See scan_source.hpp.
#include "drivers/replay/scan_source.hpp"

#include <algorithm>

#include "drivers/replay/time_leaps.hpp"

namespace lxd {
namespace {

constexpr Duration kLongestSweep = Duration::from_ns(kNanosPerSecond);  // the slowest spinning LiDAR turns at 5 Hz

std::vector<bool> find_leaps(const std::vector<std::optional<SweepTiming>>& timings) {
  StampLines stamps(timings.size());
  std::transform(timings.begin(), timings.end(), stamps.begin(), [](const std::optional<SweepTiming>& timing) {
    return timing ? std::optional(timing->stamp) : std::nullopt;
  });
  return find_time_leaps(stamps);
}

}  // namespace

ScanSource::ScanSource(ScanRecording recording, std::unique_ptr<const ScanDecoder> decoder)
    : recording_(std::move(recording)), decoder_(std::move(decoder)), leaps_(find_leaps(recording_.timings)) {
  count_missing_files();
}

// Files that the times promise and the folder lacks.
void ScanSource::count_missing_files() {
  const std::size_t lines = recording_.timings.size();
  const auto with_line = std::count_if(recording_.files.begin(), recording_.files.end(),
                                       [&](const ScanFile& file) { return file.number < lines; });
  const auto found = std::min(lines, static_cast<std::size_t>(with_line));
  count_rejected(rejected_, "missing_file", lines - found);
}

Result<bool> ScanSource::next(Sweep& sweep) {
  while (next_ < recording_.files.size()) {
    if (read(recording_.files[next_++], sweep)) return true;
  }
  return false;
}

bool ScanSource::read(const ScanFile& file, Sweep& sweep) {
  const auto timing = admit_time(file.number);
  if (!timing) return false;
  const auto floats = reader_.read(file.path, decoder_->floats_per_point(), rejected_);
  if (!floats) return false;
  sweep.begin = timing->begin;
  sweep.end = timing->end;
  sweep.stamp = timing->stamp;
  sweep.lidar = 0;
  sweep.sequence = file.number;
  sweep.count = 0;
  PointCounts counts;
  decoder_->decode(*floats, sweep, counts);
  counts.report(rejected_);
  if (sweep.count == 0) count_rejected(rejected_, "empty_sweep");
  return sweep.count > 0;
}

std::optional<SweepTiming> ScanSource::admit_time(std::uint32_t number) {
  const auto timing = number < recording_.timings.size() ? recording_.timings[number] : std::nullopt;
  if (timing && leaps_[number]) {
    count_rejected(rejected_, "time_leap");
    return std::nullopt;
  }
  if (timing && (timing->stamp < timing->begin || timing->end < timing->stamp)) {
    count_rejected(rejected_, "time_backwards");
    return std::nullopt;
  }
  if (timing && timing->end - timing->begin > kLongestSweep) {
    count_rejected(rejected_, "sweep_too_long");
    return std::nullopt;
  }
  if (!gate_.admit(timing ? std::optional(timing->stamp) : std::nullopt, rejected_)) return std::nullopt;
  return timing;
}

}  // namespace lxd
