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

class GenericDecoder final : public ScanDecoder {
 public:
  [[nodiscard]] std::size_t floats_per_point() const override { return kFloatsPerPoint; }

  void decode(std::span<const float> floats, Sweep& sweep, PointCounts& counts) const override {
    std::uint32_t last_ns = 0;
    for (std::size_t i = 0; i < floats.size(); i += kFloatsPerPoint) {
      const float* const in = &floats[i];
      if (!sound_point(in, counts)) continue;
      const float offset_s = in[4];
      if (!(offset_s >= 0 && offset_s <= kLongestOffset_s)) {
        ++counts.bad_time;
        continue;
      }
      const auto offset_ns = static_cast<std::uint32_t>(offset_s * kNanosPerSecondF + 0.5F);
      last_ns = std::max(last_ns, offset_ns);
      if (!sweep.push({in[0], in[1], in[2], in[3], offset_ns})) ++counts.above_capacity;
    }
    sweep.end = sweep.stamp = sweep.begin + Duration::from_ns(last_ns);
  }
};

}  // namespace

bool is_generic_folder(const fs::path& folder) { return fs::is_directory(folder / "lidar0"); }

Result<std::unique_ptr<SweepSource>> open_generic_folder(const fs::path& folder) {
  auto files = list_scan_files(folder / "lidar0");
  if (!files) return files.error();
  const auto stamps = read_seconds_file(folder / "lidar0" / "times.txt");
  if (!stamps) return stamps.error();
  const Duration period = median_period(*stamps);
  ScanRecording recording{.kind = "generic",
                          .files = std::move(*files),
                          .timings = instant_timings(*stamps),
                          .traits = {.rate_hz = period > Duration() ? 1 / period.seconds() : 0}};
  return std::unique_ptr<SweepSource>(
      std::make_unique<ScanSource>(std::move(recording), std::make_unique<GenericDecoder>()));
}

}  // namespace lxd
