// SPDX-License-Identifier: Apache-2.0
// The camera's automatic exposure: brightness follows the scene with a lag, first by time, then by gain.
#pragma once

#include <optional>

#include "tools/simulator/camera/camera_config.hpp"
#include "tools/simulator/camera/sensor_response.hpp"

namespace lxd::sim {

class ExposureControl {
 public:
  explicit ExposureControl(const CameraConfig& config) : config_(config) {}

  // The exposure of a frame; `metered` is the mean luminance that the previous one saw (Renderer::metered).
  Exposure next(double metered);

  // The same exposure `factor` times as bright; what does not fit into the period becomes gain.
  [[nodiscard]] Exposure brighter(const Exposure& exposure, double factor) const;

 private:
  const CameraConfig& config_;
  std::optional<double> log_product_;  // of time and gain
};

}  // namespace lxd::sim
