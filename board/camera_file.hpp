// SPDX-License-Identifier: Apache-2.0
// A camera's part of a recording: an image file a frame (MJPEG as the bytes came, .jpg; GREY and the luma of YUYV as
// .pgm, RGB3 as .ppm; of YUYV some in colour, too, in colour/), times.txt with the begin of each exposure, frames.csv
// with what else is known of it.
#pragma once

#include <filesystem>
#include <memory>

#include "board/chunk_file.hpp"
#include "board/rig.hpp"
#include "drivers/camera/frame_timing.hpp"

namespace lxd {

// Colours are told by a few images of those that a camera takes: no more than these are read, or kept beside the grey
// ones, in colour.
inline constexpr Duration kColourPeriod = Duration::from_ns(180'000'000);  // five a second, though stamps waver

// Error: the folder or its lists cannot be made.
Result<std::unique_ptr<ChunkFile>> create_camera_file(const CameraRig& rig, const std::filesystem::path& folder);

// No frame that this camera's driver hands over is longer.
std::size_t frame_bytes_max(const CameraRig& rig);

ExposureTiming exposure_timing_of(const CameraWire& wire);

}  // namespace lxd
