// SPDX-License-Identifier: Apache-2.0
// A camera's part of a recording: <name>/000000.png and so on, times.txt, frames.csv.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

#include "rt/result.hpp"
#include "tools/simulator/camera/frame_plan.hpp"

namespace lxd::sim {

// How a camera is written; not part of what it writes.
struct CameraOutput {
  unsigned threads = 1;
  std::function<void(double part)> progress{};  // 0 .. 1, from the calling thread
  const std::atomic<bool>* stop = nullptr;      // set: writing ends with an error
};

// `folder` is the recording's. The same bytes whatever the number of threads. Precondition: sees_everywhere(config).
// Errors name the file that could not be written.
Result<CameraLog> write_camera(const Context& context, const CameraConfig& config, const std::filesystem::path& folder,
                               const CameraOutput& output = {});

}  // namespace lxd::sim
