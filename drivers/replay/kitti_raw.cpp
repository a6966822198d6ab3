// SPDX-License-Identifier: Apache-2.0
// See kitti_raw.hpp. Format: Geiger et al., "Vision meets Robotics: The KITTI Dataset", IJRR 2013, and the raw devkit.
#include "drivers/replay/kitti_raw.hpp"

#include <algorithm>

#include "drivers/replay/kitti_decoder.hpp"
#include "drivers/replay/time_leaps.hpp"
#include "drivers/replay/times_file.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

constexpr Duration kNominalTurn = Duration::from_ns(kNanosPerSecond / 10);

bool is_velodyne_points(const fs::path& folder) {
  return folder.filename() == "velodyne_points" ||
         (fs::is_directory(folder / "data") && fs::exists(folder / "timestamps.txt") &&
          has_scan_files(folder / "data"));
}

std::optional<RigTime> line(const StampLines& lines, std::size_t number) {
  return number < lines.size() ? lines[number] : std::nullopt;
}

// The three stamps of each sweep, on the rig's clock.
std::vector<std::optional<SweepTiming>> join(const StampLines& begins, const StampLines& stamps, const StampLines& ends,
                                             RigTime zero) {
  const RigTime epoch;
  std::vector<std::optional<SweepTiming>> timings(stamps.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const auto begin = line(begins, i), end = line(ends, i);
    if (!begin || !stamps[i] || !end) continue;
    timings[i] = SweepTiming{epoch + (*begin - zero), epoch + (*end - zero), epoch + (*stamps[i] - zero)};
  }
  return timings;
}

StampLines shifted(StampLines lines, Duration by) {
  for (auto& stamp : lines) {
    if (stamp) stamp = *stamp + by;
  }
  return lines;
}

// A missing file is replaced by half a turn around the stamps; one that is there must be readable.
Result<StampLines> read_edge(const fs::path& path, const StampLines& stamps, Duration from_stamp,
                             std::vector<std::string>& notes) {
  if (fs::exists(path)) return read_dates_file(path);
  notes.push_back(path.filename().string() + " is missing: assumed half a turn " +
                  (from_stamp < Duration() ? "before" : "after") + " each line of timestamps.txt");
  return shifted(stamps, from_stamp);
}

}  // namespace

std::vector<fs::path> find_kitti_raw(const fs::path& folder) {
  if (is_velodyne_points(folder)) return {folder};
  if (fs::is_directory(folder / "velodyne_points")) return {folder / "velodyne_points"};
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (fs::is_directory(entry->path() / "velodyne_points", error)) found.push_back(entry->path() / "velodyne_points");
  }
  std::sort(found.begin(), found.end());
  return found;
}

Result<std::unique_ptr<SweepSource>> open_kitti_raw(const fs::path& velodyne_points, const ReplayOptions& options) {
  ScanRecording recording{.kind = "kitti-raw"};
  auto files = list_scan_files(velodyne_points / "data");
  if (!files) return files.error();
  const auto stamps = read_dates_file(velodyne_points / "timestamps.txt");
  if (!stamps) return stamps.error();
  const Duration measured = median_period(*stamps);
  const Duration turn = measured > Duration() ? measured : kNominalTurn;
  const auto begins = read_edge(velodyne_points / "timestamps_start.txt", *stamps, -(turn / 2), recording.notes);
  if (!begins) return begins.error();
  const auto ends = read_edge(velodyne_points / "timestamps_end.txt", *stamps, turn / 2, recording.notes);
  if (!ends) return ends.error();
  recording.files = std::move(*files);
  recording.timings = join(*begins, *stamps, *ends, first_sound_stamp(*stamps));
  recording.traits = hdl64_traits(turn);
  return std::unique_ptr<SweepSource>(std::make_unique<ScanSource>(
      std::move(recording),
      std::make_unique<KittiDecoder>(PointTimes::from_azimuth, options.kitti_vertical_angle_correction_rad)));
}

}  // namespace lxd
