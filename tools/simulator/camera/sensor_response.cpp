// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/sensor_response.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lxd::sim {
namespace {

// The standard normal's value below which this part lies; by bisection, for it is asked at the start only.
double normal_quantile(double part) {
  double low = -8, high = 8;
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (std::erfc(-middle / std::numbers::sqrt2) / 2 < part ? low : high) = middle;
  }
  return (low + high) / 2;
}

// Light that is missing grows with the square of the distance from the principal point, to the farthest corner.
std::vector<float> vignette_of(const CameraConfig& config) {
  const double width = config.resolution[0], height = config.resolution[1];
  const double cx = config.intrinsics[2], cy = config.intrinsics[3];
  const double farthest = std::hypot(std::max(cx, width - 1 - cx), std::max(cy, height - 1 - cy));
  std::vector<float> factors;
  for (double v = 0; v < height; ++v) {
    for (double u = 0; u < width; ++u) {
      const double radius = std::hypot(u - cx, v - cy) / farthest;
      factors.push_back(static_cast<float>(1 - config.vignetting * radius * radius));
    }
  }
  return factors;
}

// Indices into the table of normals, several out of each draw of 64 bits.
class NormalIndices {
 public:
  NormalIndices(Random random, int bits) : random_(random), bits_(bits) {}

  std::size_t next() {
    if (left_ < bits_) {
      word_ = random_.bits();
      left_ = kWord;
    }
    const std::uint64_t index = word_ & ((1ULL << static_cast<unsigned>(bits_)) - 1);
    word_ >>= static_cast<unsigned>(bits_);
    left_ -= bits_;
    return index;
  }

 private:
  static constexpr int kWord = 64;
  Random random_;
  int bits_;
  int left_ = 0;
  std::uint64_t word_ = 0;
};

}  // namespace

SensorResponse::SensorResponse(const CameraConfig& config)
    : light_(config.low_light ? CameraConfig::kLowLight : 1.0),
      full_well_e_(config.full_well_e),
      read_noise_e_(config.read_noise_e),
      shot_noise_(config.shot_noise),
      vignette_(vignette_of(config)) {
  for (std::size_t i = 0; i < normal_.size(); ++i)
    normal_[i] =
        static_cast<float>(normal_quantile((static_cast<double>(i) + 0.5) / static_cast<double>(normal_.size())));
  for (int i = 0; i <= kGammaSteps; ++i)
    gamma_[static_cast<std::size_t>(i)] = encoded(static_cast<double>(i) / kGammaSteps);
}

// IEC 61966-2-1 (sRGB).
std::uint8_t SensorResponse::encoded(double part) {
  const double x = std::clamp(part, 0.0, 1.0);
  const double value = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * value));
}

void SensorResponse::apply(const RadianceImage& light, const Exposure& exposure, Random random,
                           PixelImage& image) const {
  image.width = light.width;
  image.height = light.height;
  image.channels = light.channels;
  image.data.resize(light.radiance.size());
  const auto full_well = static_cast<float>(full_well_e_);
  const auto electrons = static_cast<float>(light_ * exposure.duration_s / kSaturation_s * full_well_e_);
  const auto steps = static_cast<float>(exposure.gain / full_well_e_ * kGammaSteps);
  const auto read_variance = static_cast<float>(read_noise_e_ * read_noise_e_);
  const bool noisy = shot_noise_ || read_variance > 0;
  NormalIndices chance(random, kNormalBits);
  const auto channels = static_cast<std::size_t>(light.channels);
  for (std::size_t pixel = 0, i = 0; pixel < vignette_.size(); ++pixel) {
    for (std::size_t c = 0; c < channels; ++c, ++i) {
      float e = std::min(full_well, electrons * vignette_[pixel] * light.radiance[i]);
      if (noisy) e += std::sqrt((shot_noise_ ? e : 0.0F) + read_variance) * normal_[chance.next()];
      const float step = std::clamp(e * steps + 0.5F, 0.0F, static_cast<float>(kGammaSteps));
      image.data[i] = gamma_[static_cast<std::size_t>(step)];
    }
  }
}

}  // namespace lxd::sim
