// SPDX-License-Identifier: Apache-2.0
// Images of a plane with a random texture under known homographies, for tests that track features: every pixel is
// computed from the texture itself, so that the truth is exact.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "estimator/vision/front_end/feature_tracker.hpp"

namespace lxd::test {

// Smooth random values of the plane, three octaves, 0..1; unit: pixels of the first image.
class Texture {
 public:
  explicit Texture(std::uint64_t seed) : seed_(seed) {}
  [[nodiscard]] double at(double x, double y) const {
    return 0.45 * octave(x / 37, y / 37, 1) + 0.35 * octave(x / 15, y / 15, 2) + 0.2 * octave(x / 6.5, y / 6.5, 3);
  }

 private:
  [[nodiscard]] double value(std::int64_t i, std::int64_t k, std::uint64_t salt) const {
    std::uint64_t h = seed_ + salt * 0x9E3779B97F4A7C15ull + static_cast<std::uint64_t>(i) * 0xBF58476D1CE4E5B9ull +
                      static_cast<std::uint64_t>(k) * 0x94D049BB133111EBull;
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>(h >> 40) / static_cast<double>(1 << 24);
  }
  [[nodiscard]] double octave(double x, double y, std::uint64_t salt) const {
    const double fx = std::floor(x), fy = std::floor(y);
    const auto smooth = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
    const double a = smooth(x - fx), b = smooth(y - fy);
    const auto i = static_cast<std::int64_t>(fx), k = static_cast<std::int64_t>(fy);
    return (1 - b) * ((1 - a) * value(i, k, salt) + a * value(i + 1, k, salt)) +
           b * ((1 - a) * value(i, k + 1, salt) + a * value(i + 1, k + 1, salt));
  }
  std::uint64_t seed_;
};

struct VideoImage {
  std::vector<std::uint8_t> pixels;
  GreyImage grey;
};

// What a pixel of the first image is in this one.
using Warp = Eigen::Matrix3d;

inline Eigen::Vector2d warped(const Warp& H, const Eigen::Vector2d& pixel) {
  return (H * pixel.homogeneous()).hnormalized();
}

inline Warp shift(double du, double dv) {
  Warp H = Warp::Identity();
  H.col(2) << du, dv, 1;
  return H;
}

// About the image's middle: turned by `angle_rad`, `scale` times as large, moved, and tilted a little.
inline Warp motion(double angle_rad, double scale, double du, double dv, double tilt = 0) {
  Warp turn = Warp::Identity();
  turn.topLeftCorner<2, 2>() = scale * Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
  turn(2, 0) = tilt;
  return shift(320 + du, 240 + dv) * turn * shift(-320, -240);
}

class TextureVideo {
 public:
  static constexpr int kWidth = 640, kHeight = 480;
  double gain = 1, noise = 1;  // grey levels: times, standard deviation
  bool patch_moves = false;    // 200 x 160 pixels about (320, 240) carry another texture that moves by patch_warp
  Warp patch_warp = Warp::Identity();

  VideoImage image(const Warp& H, double t_s) {
    const Warp back = H.inverse(), patch_back = patch_warp.inverse();
    std::normal_distribution<double> chance(0, 1);
    VideoImage out;
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) {
        Eigen::Vector2d at = warped(back, {u, v});
        double light = texture_.at(at.x(), at.y());
        if (patch_moves) {
          at = warped(patch_back, {u, v});
          if (on_patch(at)) light = other_.at(at.x(), at.y());
        }
        const double level = gain * (30 + 190 * light) + noise * chance(random_);
        out.pixels.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L)));
      }
    out.grey = {RigTime::from_seconds(t_s), kWidth, kHeight, kWidth, out.pixels};
    return out;
  }

  static bool on_patch(const Eigen::Vector2d& p) { return std::abs(p.x() - 320) < 100 && std::abs(p.y() - 240) < 80; }

 private:
  Texture texture_{1}, other_{77};
  std::mt19937 random_{5};
};

}  // namespace lxd::test
