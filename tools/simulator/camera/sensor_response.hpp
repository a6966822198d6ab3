// SPDX-License-Identifier: Apache-2.0
// From radiance to the pixels of an image sensor: electrons, their noise, gain, saturation, gamma.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/recording/pixel_image.hpp"
#include "tools/simulator/camera/camera_config.hpp"
#include "tools/simulator/camera/radiance_image.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim {

struct Exposure {
  double duration_s = 0.008;
  double gain = 1;
};

// At gain 1 a white surface in full light fills a pixel in this time.
inline constexpr double kSaturation_s = 0.012;

class SensorResponse {
 public:
  explicit SensorResponse(const CameraConfig& config);

  // The same random stream gives the same image.
  void apply(const RadianceImage& light, const Exposure& exposure, Random random, PixelImage& image) const;

  // The gamma alone: of a part of the full scale, 0 .. 1.
  [[nodiscard]] static std::uint8_t encoded(double part);

 private:
  static constexpr int kNormalBits = 12;
  static constexpr int kGammaSteps = 1 << 14;

  double light_;
  double full_well_e_, read_noise_e_;
  bool shot_noise_;
  std::vector<float> vignette_;  // as the pixels
  std::array<float, 1 << kNormalBits> normal_{};
  std::array<std::uint8_t, kGammaSteps + 1> gamma_{};
};

}  // namespace lxd::sim
