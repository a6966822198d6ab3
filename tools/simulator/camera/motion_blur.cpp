// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/motion_blur.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lxd::sim {
namespace {

constexpr float kFelt_px = 0.5F;  // less is within a pixel's own extent
constexpr int kProbe_px = 16;     // how sparsely an image is asked whether it moves at all
constexpr double kFar_m = 1e5;    // for the range of the sky: only turning moves it
constexpr float kSamplesMax = 64;

class Smear {
 public:
  Smear(const CameraModel& model, const RayTable& rays, const ExposureMotion& motion, RadianceImage& image)
      : model_(model), rays_(rays), motion_(motion), image_(image) {}

  // How far what pixel (u, v) shows moves over the sensor from begin to end, pixels.
  [[nodiscard]] Eigen::Vector2f way(int u, int v) const {
    const double range_m = std::min<double>(image_.range_m[image_.index(u, v)], kFar_m);
    const Eigen::Vector3d p_middle = range_m * rays_.at(u, v).cast<double>();
    const Eigen::Vector2d centre(u, v);
    const Eigen::Vector2d begin = model_.project(motion_.T_begin_middle * p_middle).value_or(centre);
    const Eigen::Vector2d end = model_.project(motion_.T_end_middle * p_middle).value_or(centre);
    return (end - begin).cast<float>();
  }

  [[nodiscard]] bool moves() const {
    for (int v = kProbe_px / 2; v < image_.height; v += kProbe_px) {
      for (int u = kProbe_px / 2; u < image_.width; u += kProbe_px) {
        if (way(u, v).norm() >= kFelt_px) return true;
      }
    }
    return false;
  }

  void apply() {
    sharp_ = image_.radiance;
    for (int v = 0; v < image_.height; ++v) {
      for (int u = 0; u < image_.width; ++u) average(u, v, way(u, v));
    }
  }

 private:
  void average(int u, int v, const Eigen::Vector2f& way_px) {
    const float length_px = way_px.norm();
    if (length_px < kFelt_px) return;
    const float samples = std::min(kSamplesMax, std::ceil(length_px) + 1);
    float sum[3] = {0, 0, 0};
    for (float i = 0.5F; i < samples; ++i) {
      const float part = i / samples - 0.5F;
      add(static_cast<float>(u) - part * way_px.x(), static_cast<float>(v) - part * way_px.y(), sum);
    }
    float* const out = &image_.radiance[image_.index(u, v) * static_cast<std::size_t>(image_.channels)];
    for (int c = 0; c < image_.channels; ++c) out[c] = sum[c] / samples;
  }

  // The sharp image between pixels, bilinear; beyond the border it goes on as the border is.
  void add(float x, float y, float* sum) const {
    x = std::clamp(x, 0.0F, static_cast<float>(image_.width - 1));
    y = std::clamp(y, 0.0F, static_cast<float>(image_.height - 1));
    const int u = std::min(static_cast<int>(x), image_.width - 2), v = std::min(static_cast<int>(y), image_.height - 2);
    const float a = x - static_cast<float>(u), b = y - static_cast<float>(v);
    const auto channels = static_cast<std::size_t>(image_.channels);
    const float* const upper = &sharp_[image_.index(u, v) * channels];
    const float* const lower = &sharp_[image_.index(u, v + 1) * channels];
    for (std::size_t c = 0; c < channels; ++c) {
      const float above = upper[c] + a * (upper[c + channels] - upper[c]);
      const float below = lower[c] + a * (lower[c + channels] - lower[c]);
      sum[c] += above + b * (below - above);
    }
  }

  const CameraModel& model_;
  const RayTable& rays_;
  const ExposureMotion& motion_;
  RadianceImage& image_;
  std::vector<float> sharp_;
};

}  // namespace

void blur(const CameraModel& model, const RayTable& rays, const ExposureMotion& motion, RadianceImage& image) {
  Smear smear(model, rays, motion, image);
  if (smear.moves()) smear.apply();
}

}  // namespace lxd::sim
