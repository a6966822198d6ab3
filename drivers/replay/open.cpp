// SPDX-License-Identifier: Apache-2.0
// See open.hpp.
#include "drivers/replay/open.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "drivers/replay/generic_folder.hpp"
#include "drivers/replay/kitti_odometry.hpp"
#include "drivers/replay/kitti_raw.hpp"
#include "drivers/replay/livox_pcap.hpp"
#include "drivers/replay/livox_stream.hpp"
#include "drivers/replay/ouster_metadata_file.hpp"
#include "drivers/replay/ouster_pcap.hpp"
#include "drivers/replay/pps_log.hpp"
#include "drivers/replay/rig_clock.hpp"
#include "drivers/replay/rig_recording.hpp"
#include "drivers/replay/unfinished_recording.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;
using Opened = Result<std::unique_ptr<SweepSource>>;

constexpr const char* kWanted =
    "wanted one of\n"
    "  rig recording: lidar0.pcap, and lidar0.json when it is an Ouster's\n"
    "  KITTI raw drive: velodyne_points/ with data/*.bin, timestamps.txt, timestamps_start.txt, timestamps_end.txt\n"
    "  KITTI odometry sequence: velodyne/*.bin and times.txt\n"
    "  generic folder: lidar0/000000.bin and so on, and lidar0/times.txt\n"
    "  Ouster capture: a .pcap file with the sensor's metadata .json beside it\n"
    "  Livox capture: a .pcap file with its point packets";

// The folder's first entries, for the message.
std::string contents(const fs::path& folder) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    names.push_back(entry->path().filename().string() + (entry->is_directory(error) ? "/" : ""));
  }
  if (names.empty()) return "nothing";
  std::sort(names.begin(), names.end());
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) list += (i > 0 ? ", " : "") + names[i];
  if (names.size() > kMost) list += " and " + std::to_string(names.size() - kMost) + " more";
  return list;
}

Error ambiguous(const fs::path& path, const std::vector<fs::path>& candidates) {
  std::string list;
  for (const fs::path& candidate : candidates) list += "\n  " + candidate.string();
  return Error{
      fmt::format("{}: found {} recordings, wanted one; name one of{}", path.string(), candidates.size(), list)};
}

// Of what `record` and `simulate` write, as it is or said to be unfinished.
Opened marked(Opened opened, const fs::path& folder) {
  if (!is_unfinished(folder)) return opened;
  if (!opened) return Error{fmt::format("{} (the recording was not finished)", opened.error().message)};
  return mark_unfinished(std::move(*opened), folder);
}

Opened open_folder(const fs::path& folder, const ReplayOptions& options) {
  const auto raw = find_kitti_raw(folder);
  const auto odometry = find_kitti_odometry(folder);
  std::vector<fs::path> all = raw;
  all.insert(all.end(), odometry.begin(), odometry.end());
  const bool generic = is_generic_folder(folder);
  if (generic) all.push_back(folder / "lidar0");
  const bool rig = is_rig_recording(folder);
  if (rig) all.push_back(folder / "lidar0.pcap");
  if (all.empty()) return Error{fmt::format("{}: found {}; {}", folder.string(), contents(folder), kWanted)};
  if (all.size() > 1) return ambiguous(folder, all);
  if (generic) return marked(open_generic_folder(folder), folder);
  if (rig) return marked(open_rig_recording(folder, options.pulsed.lidar0), folder);
  return raw.empty() ? open_kitti_odometry(odometry.front(), options) : open_kitti_raw(raw.front(), options);
}

// An Ouster's packets mean nothing without its metadata; where there are none, it may be a Livox.
Opened open_capture(const fs::path& path) {
  if (!find_ouster_metadata(path) && find_livox_stream(path)) return open_livox_pcap(path, nullptr, "livox-pcap");
  return open_ouster_pcap(path);
}

Opened open_path(const fs::path& path, const ReplayOptions& options) {
  if (!fs::exists(path)) return Error{fmt::format("{}: no such file or folder", path.string())};
  if (fs::is_directory(path)) return open_folder(path, options);
  if (looks_like_pcap(path)) return marked(open_capture(path), path.parent_path());
  return Error{fmt::format("{}: found a file that is no packet capture; {}", path.string(), kWanted)};
}

}  // namespace

Opened open_extra_lidar(const fs::path& folder, bool pulsed) {
  std::error_code ignored;
  if (fs::is_regular_file(folder / "lidar1.pcap", ignored)) {
    auto pulses = recorded_pulses(folder, pulsed);
    if (!pulses) return pulses.error();
    return open_rig_lidar(folder, "lidar1", std::make_unique<RigClock>(ClockModelConfig{}, std::move(*pulses)));
  }
  if (fs::is_directory(folder / "lidar1", ignored)) return open_generic_folder(folder, "lidar1");
  return Error{fmt::format("{}: found no recording of a second LiDAR, wanted lidar1.pcap or lidar1/", folder.string())};
}

Opened open_recording(const fs::path& path, const ReplayOptions& options) {
  // "drive/" has an empty last part, which would hide the folder's name from the recognisers.
  const fs::path clean = path.has_filename() ? path : path.parent_path();
  try {
    return open_path(clean, options);
  } catch (const fs::filesystem_error& error) {  // e.g. a folder without permission
    return Error{fmt::format("{}: {}", clean.string(), error.what())};
  }
}

}  // namespace lxd
