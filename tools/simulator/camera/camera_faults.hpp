// SPDX-License-Identifier: Apache-2.0
// What can be wrong with a camera.
#pragma once

#include <span>
#include <string_view>

#include "tools/recording/pixel_image.hpp"
#include "tools/simulator/camera/radiance_image.hpp"
#include "tools/simulator/faults.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim {

inline constexpr std::string_view kCameraExposureJump = "camera_exposure_jump";
inline constexpr std::string_view kCameraCorrupt = "camera_corrupt";
inline constexpr std::string_view kCameraDrop = "camera_drop";
inline constexpr std::string_view kCameraUnplugged = "camera_unplugged";

std::span<const KnownFault> camera_faults();

// What a transfer that breaks off leaves: below some row stripes of noise and of rows from above.
void corrupt(PixelImage& image, Random random);

}  // namespace lxd::sim
