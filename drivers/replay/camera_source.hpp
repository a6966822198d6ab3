// SPDX-License-Identifier: Apache-2.0
// Which of a recording's folders is its camera, and on which clock.
#pragma once

#include <filesystem>

#include "drivers/replay/camera_folder.hpp"

namespace lxd {

// camera0/ of a rig recording or a generic folder; of a KITTI raw drive the first of image_00 to image_03, its stamps
// counted from the Velodyne's; of a KITTI odometry sequence the first of image_0 to image_3. Error: there is none.
Result<CameraFolder> open_camera(const std::filesystem::path& recording);

}  // namespace lxd
