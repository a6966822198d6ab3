// SPDX-License-Identifier: Apache-2.0
// The smear of an exposure during which the camera moves. The image of the exposure's middle is averaged along each
// pixel's way over the sensor, which range and motion give exactly for what stands still; what moves by itself is
// smeared by the camera's motion only, and what comes out from behind an edge during the exposure is taken from beside
// it.
#pragma once

#include "rt/pose.hpp"
#include "tools/simulator/camera/camera_model.hpp"
#include "tools/simulator/camera/radiance_image.hpp"
#include "tools/simulator/camera/ray_table.hpp"

namespace lxd::sim {

// Where the camera is at the exposure's begin and end, seen from its middle.
struct ExposureMotion {
  Pose T_begin_middle;
  Pose T_end_middle;
};

// Leaves the image as it is when nothing moves by half a pixel. The blurred image's ranges are the sharp one's.
void blur(const CameraModel& model, const RayTable& rays, const ExposureMotion& motion, RadianceImage& image);

}  // namespace lxd::sim
