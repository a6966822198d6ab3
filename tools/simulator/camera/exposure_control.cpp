// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/exposure_control.hpp"

#include <algorithm>
#include <cmath>

namespace lxd::sim {
namespace {

constexpr double kMiddleGrey = 0.18;  // of the full scale: what the mean is brought to
constexpr double kFollows = 0.3;      // part of the difference, in logarithms, that one frame makes up for
constexpr double kDarkest = 1e-3;
constexpr double kShortest_s = 20e-6;

}  // namespace

Exposure ExposureControl::next(double metered) {
  if (!config_.auto_exposure) return {config_.exposure_s, config_.gain};
  const double light = (config_.low_light ? CameraConfig::kLowLight : 1.0) * std::max(metered, kDarkest);
  const double wanted = std::log(kMiddleGrey * kSaturation_s / light);
  log_product_ = log_product_ ? *log_product_ + kFollows * (wanted - *log_product_) : wanted;
  const double product_s = std::exp(*log_product_);
  const double duration_s = std::clamp(product_s / config_.gain, kShortest_s, config_.exposure_max_s);
  return {duration_s, std::clamp(product_s / duration_s, config_.gain, config_.gain_max)};
}

Exposure ExposureControl::brighter(const Exposure& exposure, double factor) const {
  const double wanted_s = exposure.duration_s * factor;
  const double duration_s = std::clamp(wanted_s, kShortest_s, CameraConfig::kLongestExposure / config_.rate_hz);
  return {duration_s, exposure.gain * wanted_s / duration_s};
}

}  // namespace lxd::sim
