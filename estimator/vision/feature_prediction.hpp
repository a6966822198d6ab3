// SPDX-License-Identifier: Apache-2.0
// Where features should be in the next image, by a motion that is known from elsewhere. Real-time safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "estimator/vision/camera_model.hpp"
#include "estimator/vision/feature_frame.hpp"

namespace lxd {

struct PredictedPixel {
  std::uint32_t id;
  Eigen::Vector2f pixel;
};

// Predictions for all features of a frame when the camera has turned: R_now_before takes bearings from its frame before
// to the one now. Those that leave the image are left out. Real-time safe; gives how many were written.
std::size_t predict_by_turn(const FeatureFrame& before, const Eigen::Matrix3d& R_now_before, const CameraModel& camera,
                            std::span<PredictedPixel> predictions) noexcept;

}  // namespace lxd
