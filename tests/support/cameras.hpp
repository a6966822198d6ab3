// SPDX-License-Identifier: Apache-2.0
// Cameras of the estimator in a test: 640 x 480, without distortion, wide with radtan, fisheye.
#pragma once

#include "estimator/vision/camera_model.hpp"

namespace lxd::test {

inline CameraIntrinsics plain_camera() {
  return {.resolution = {640, 480}, .focal_px = {420, 425}, .centre_px = {322, 241}};
}

inline CameraIntrinsics radtan_camera() {
  CameraIntrinsics camera = plain_camera();
  camera.distortion = Distortion::radtan;
  camera.coefficients = {-0.28, 0.07, 2e-4, -3e-4};
  return camera;
}

inline CameraIntrinsics fisheye_camera() {
  CameraIntrinsics camera = plain_camera();
  camera.focal_px = {190, 191};
  camera.distortion = Distortion::equidistant;
  camera.coefficients = {-0.013, 0.02, -0.012, 0.002};
  return camera;
}

}  // namespace lxd::test
