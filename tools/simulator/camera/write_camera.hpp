// SPDX-License-Identifier: Apache-2.0
// A camera's part of a recording: <name>/000000.png and so on, times.txt, frames.csv.
#pragma once

#include <filesystem>

#include "rt/result.hpp"
#include "tools/simulator/camera/frame_plan.hpp"

namespace lxd::sim {

// `folder` is the recording's. The same bytes whatever the number of threads. Precondition: sees_everywhere(config).
// Errors name the file that could not be written.
Result<CameraLog> write_camera(const Context& context, const CameraConfig& config, const std::filesystem::path& folder,
                               unsigned threads = 1);

}  // namespace lxd::sim
