// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/camera_source.hpp"

#include <array>

#include <fmt/format.h>

#include "drivers/replay/kitti_odometry.hpp"
#include "drivers/replay/kitti_raw.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

constexpr std::array kRawCameras{"image_00", "image_01", "image_02", "image_03"};
constexpr std::array kOdometryCameras{"image_0", "image_1", "image_2", "image_3"};

// Empty: none of them.
fs::path first_there(const fs::path& folder, std::span<const char* const> names) {
  std::error_code ignored;
  for (const char* const name : names)
    if (fs::is_directory(folder / name, ignored)) return folder / name;
  return {};
}

// The stamp that the drive's sweeps are counted from.
std::optional<RigTime> zero_of(const fs::path& drive) {
  const auto stamps = read_dates_file(drive / "velodyne_points" / "timestamps.txt");
  if (!stamps) return std::nullopt;
  for (const auto& stamp : *stamps)
    if (stamp) return stamp;
  return std::nullopt;
}

}  // namespace

Result<CameraFolder> open_camera(const fs::path& recording) {
  const fs::path own = first_there(recording, std::array{"camera0"});
  if (!own.empty()) return CameraFolder::open(own);
  for (const fs::path& drive : find_kitti_raw(recording)) {
    const fs::path images = first_there(drive, kRawCameras);
    if (!images.empty()) return CameraFolder::open(images, zero_of(drive));
  }
  for (const fs::path& sequence : find_kitti_odometry(recording)) {
    const fs::path images = first_there(sequence, kOdometryCameras);
    if (!images.empty()) return CameraFolder::open(images);
  }
  return Error{fmt::format("{}: found no images of a camera, wanted camera0/", recording.string())};
}

}  // namespace lxd
