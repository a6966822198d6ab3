// SPDX-License-Identifier: Apache-2.0
// See generic_folder.hpp.
#include "drivers/replay/generic_folder.hpp"

#include <algorithm>

#include "drivers/replay/instant_timings.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFloatsPerPoint = 5;
constexpr float kNanosPerSecondF = 1e9F;
constexpr float kLongestOffset_s = 1;  // the slowest spinning LiDAR turns at 5 Hz
// Against the recording's median period: a point later than the first is not of this sweep; points later than the
// second are believed when they are more than a few, since one alone would move the sweep's end.
constexpr float kLatestPeriods = 1.5F;
constexpr float kOrdinaryPeriods = 1.1F;
constexpr std::uint32_t kFewPart = 1000;  // few: less than this part of the sweep's points

std::uint32_t latest_offset_ns(const Sweep& sweep) {
  std::uint32_t latest_ns = 0;
  for (const LidarPoint& point : sweep.points()) latest_ns = std::max(latest_ns, point.offset_ns);
  return latest_ns;
}

// Takes points later than ordinary_ns out of the sweep when they are few; how many.
std::uint32_t drop_few_later(Sweep& sweep, std::uint32_t ordinary_ns) {
  const auto points = sweep.storage.first(sweep.count);
  const auto is_later = [&](const LidarPoint& point) { return point.offset_ns > ordinary_ns; };
  const auto later = static_cast<std::uint32_t>(std::count_if(points.begin(), points.end(), is_later));
  if (later == 0 || std::uint64_t{later} * kFewPart >= sweep.count) return 0;
  std::remove_if(points.begin(), points.end(), is_later);
  sweep.count -= later;
  return later;
}

class GenericDecoder final : public ScanDecoder {
 public:
  // period: of the recording; zero: unknown.
  explicit GenericDecoder(Duration period)
      : latest_s_(period > Duration() ? std::min(kLongestOffset_s, kLatestPeriods * seconds(period))
                                      : kLongestOffset_s),
        ordinary_ns_(to_ns(period > Duration() ? std::min(latest_s_, kOrdinaryPeriods * seconds(period)) : latest_s_)) {
  }

  [[nodiscard]] std::size_t floats_per_point() const override { return kFloatsPerPoint; }

  void decode(std::span<const float> floats, Sweep& sweep, PointCounts& counts) const override {
    for (std::size_t i = 0; i < floats.size(); i += kFloatsPerPoint) {
      const float* const in = &floats[i];
      if (!sound_point(in, counts)) continue;
      const float offset_s = in[4];
      if (!(offset_s >= 0 && offset_s <= latest_s_)) {
        ++counts.bad_time;
        continue;
      }
      if (!sweep.push({in[0], in[1], in[2], in[3], to_ns(offset_s)})) ++counts.above_capacity;
    }
    counts.bad_time += drop_few_later(sweep, ordinary_ns_);
    sweep.end = sweep.stamp = sweep.begin + Duration::from_ns(latest_offset_ns(sweep));
  }

 private:
  static float seconds(Duration span) { return static_cast<float>(span.seconds()); }
  static std::uint32_t to_ns(float offset_s) { return static_cast<std::uint32_t>(offset_s * kNanosPerSecondF + 0.5F); }

  float latest_s_;
  std::uint32_t ordinary_ns_;
};

}  // namespace

bool is_generic_folder(const fs::path& folder) { return fs::is_directory(folder / "lidar0"); }

Result<std::unique_ptr<SweepSource>> open_generic_folder(const fs::path& folder, const std::string& lidar) {
  auto files = list_scan_files(folder / lidar);
  if (!files) return files.error();
  const auto stamps = read_seconds_file(folder / lidar / "times.txt");
  if (!stamps) return stamps.error();
  const Duration period = median_period(*stamps);
  ScanRecording recording{.kind = "generic",
                          .files = std::move(*files),
                          .timings = instant_timings(*stamps),
                          .traits = {.rate_hz = period > Duration() ? 1 / period.seconds() : 0}};
  return std::unique_ptr<SweepSource>(
      std::make_unique<ScanSource>(std::move(recording), std::make_unique<GenericDecoder>(period)));
}

}  // namespace lxd
