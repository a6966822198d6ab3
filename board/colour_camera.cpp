// SPDX-License-Identifier: Apache-2.0
#include "board/colour_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "backend/colour/srgb.hpp"

namespace lxd {
namespace {

// A vertex stands for a decimetre: at ten metres that is two pixels of such an image.
constexpr double kLongSide_px = 320;
constexpr double kWidestTangent = 1.6;  // 58 degrees from the axis: beyond, a plane image is nothing but its corners
constexpr double kBorder_px = 4;        // of the camera's image, where lenses are least well known
constexpr std::uint8_t kOverexposed = 250;
constexpr int kColourChannels = 3;

struct Window {
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = low;  // tangents

  void include(const Eigen::Vector3d& bearing) {
    const double depth = std::max(bearing.z(), 1e-9);
    const Eigen::Vector2d tangent = (bearing.head<2>() / depth).cwiseMax(-kWidestTangent).cwiseMin(kWidestTangent);
    low = low.cwiseMin(tangent);
    high = high.cwiseMax(tangent);
  }
};

// All that the border of the image sees.
Window window_of(const CameraModel& model) {
  constexpr int kSteps = 32;
  const double right = model.intrinsics().resolution[0] - 1.0, below = model.intrinsics().resolution[1] - 1.0;
  Window window;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = right * i / kSteps, v = below * i / kSteps;
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(u, 0), Eigen::Vector2d(u, below), Eigen::Vector2d(0, v), Eigen::Vector2d(right, v)}) {
      Eigen::Vector3d bearing;
      if (model.unproject(pixel, bearing)) window.include(bearing);
    }
  }
  return window;
}

PinholeView view_of_window(const Window& window, double focal_max_px) {
  const Eigen::Vector2d size = (window.high - window.low).cwiseMax(1e-3);
  const double focal = std::min(focal_max_px, kLongSide_px / size.maxCoeff());
  PinholeView view;
  view.width = std::max(1, static_cast<int>(focal * size.x()));
  view.height = std::max(1, static_cast<int>(focal * size.y()));
  view.focal_px = static_cast<float>(focal);
  view.centre_px = (-focal * window.low).cast<float>();
  return view;
}

// The light between four pixels. False: one of them is overexposed.
bool add_light(const ColourPixels& image, const Eigen::Vector2f& at, const Lights& light, Eigen::Array3f& sum) {
  const Eigen::Vector2f floor = at.array().floor(), part = at - floor;
  const std::size_t row = std::size_t{kColourChannels} * image.width;
  const std::uint8_t* const upper = image.data.data() + static_cast<std::size_t>(floor.y()) * row +
                                    static_cast<std::size_t>(floor.x()) * kColourChannels;
  const std::uint8_t* const lower = upper + row;
  for (const std::uint8_t* const tap : {upper, upper + kColourChannels, lower, lower + kColourChannels})
    if (std::max({tap[0], tap[1], tap[2]}) >= kOverexposed) return false;
  sum += light_between(upper, lower, part, light);
  return true;
}

}  // namespace

ColourCamera::ColourCamera(const MountedCamera& camera)
    : resolution_(camera.model.intrinsics().resolution), T_body_camera_(camera.T_body_camera) {
  const double focal_px = camera.model.intrinsics().focal_px.minCoeff();
  view_ = view_of_window(window_of(camera.model), focal_px);
  const double shrunk = focal_px / view_.focal_px;
  taps_ = std::max(1, static_cast<int>(shrunk));
  tap_px_ = static_cast<float>(shrunk / taps_);
  const double margin = kBorder_px + shrunk;
  constexpr float kOff = std::numeric_limits<float>::infinity();
  sources_.reserve(view_.pixels());
  for (int y = 0; y < view_.height; ++y) {
    for (int x = 0; x < view_.width; ++x) {
      const Eigen::Vector2f bent =
          (Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - view_.centre_px) / view_.focal_px;
      Eigen::Vector2d pixel;
      const bool seen =
          camera.model.project(Eigen::Vector3d(bent.x(), bent.y(), 1), pixel) && camera.model.contains(pixel, margin);
      sources_.push_back(seen ? Eigen::Vector2f(pixel.cast<float>()) : Eigen::Vector2f(kOff, kOff));
    }
  }
}

std::vector<std::uint8_t> ColourCamera::key_pixels(const ColourPixels& image) const {
  if (image.width != resolution_[0] || image.height != resolution_[1]) return {};
  std::vector<std::uint8_t> rgb(kColourChannels * sources_.size(), kBlindLevel);
  const Lights& light = lights();
  const float first = -tap_px_ * static_cast<float>(taps_ - 1) / 2;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (!std::isfinite(sources_[i].x())) continue;
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    bool sound = true;
    for (int tap = 0; tap < taps_ * taps_ && sound; ++tap) {
      const Eigen::Vector2f shift(static_cast<float>(tap % taps_), static_cast<float>(tap / taps_));
      const Eigen::Vector2f at = sources_[i].array() + first + tap_px_ * shift.array();
      sound = add_light(image, at, light, sum);
    }
    if (!sound) continue;
    sum /= static_cast<float>(taps_ * taps_);
    for (std::size_t c = 0; c < kColourChannels; ++c)
      rgb[kColourChannels * i + c] = level_of(sum[kColourChannels - 1 - c]);
  }
  return rgb;
}

}  // namespace lxd
