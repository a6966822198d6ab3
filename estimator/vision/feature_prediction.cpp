// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/feature_prediction.hpp"

namespace lxd {

std::size_t predict_by_turn(const FeatureFrame& before, const Eigen::Matrix3d& R_now_before, const CameraModel& camera,
                            std::span<PredictedPixel> predictions) noexcept {
  std::size_t count = 0;
  for (const Feature& feature : before.features()) {
    Eigen::Vector2d pixel;
    if (count == predictions.size()) break;
    if (!camera.project(R_now_before * feature.direction(), pixel) || !camera.contains(pixel)) continue;
    predictions[count++] = {feature.id, pixel.cast<float>()};
  }
  return count;
}

}  // namespace lxd
