// SPDX-License-Identifier: Apache-2.0
// See kitti_odometry.hpp.
#include "drivers/replay/kitti_odometry.hpp"

#include <algorithm>

#include "drivers/replay/instant_timings.hpp"
#include "drivers/replay/kitti_decoder.hpp"

namespace lxd {

namespace fs = std::filesystem;

std::vector<fs::path> find_kitti_odometry(const fs::path& folder) {
  if (fs::is_directory(folder / "velodyne")) return {folder};
  const fs::path parent = folder.filename() == "sequences" ? folder : folder / "sequences";
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    if (fs::is_directory(entry->path() / "velodyne", error)) found.push_back(entry->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

Result<std::unique_ptr<SweepSource>> open_kitti_odometry(const fs::path& sequence, const ReplayOptions& options) {
  auto files = list_scan_files(sequence / "velodyne");
  if (!files) return files.error();
  const auto stamps = read_seconds_file(sequence / "times.txt");
  if (!stamps) return stamps.error();
  // The folder's layout is everyone's; KITTI's own sequences are known by their calibration.
  const bool is_kittis_own = fs::is_regular_file(sequence / "calib.txt");
  const double correction_rad = is_kittis_own ? options.kitti_vertical_angle_correction_rad : 0.0;
  ScanRecording recording{.kind = "kitti-odometry",
                          .files = std::move(*files),
                          .timings = instant_timings(*stamps),
                          .traits = hdl64_traits(median_period(*stamps))};
  return std::unique_ptr<SweepSource>(std::make_unique<ScanSource>(
      std::move(recording), std::make_unique<KittiDecoder>(PointTimes::all_at_begin, correction_rad)));
}

}  // namespace lxd
