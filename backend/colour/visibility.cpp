// SPDX-License-Identifier: Apache-2.0
#include "backend/colour/visibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lxd {
namespace {

constexpr float kCosineMin = 0.06F;  // 86.6 degrees: floors far ahead of a low camera
// What lies before a surface by less than this is the surface: the mesh's own steps.
constexpr float kStep_m = 0.08F;
constexpr float kStepPerDepth = 0.5F;  // of the depth that the surface itself gains on the way to that pixel
// How far around a vertex nothing may hide it: calibration, time and pose are off by as much.
constexpr float kMargin_px = 2, kMarginMax_px = 8;
constexpr float kRimWeight = 0.25F;
constexpr float kPixelsWanted = 2;  // across what a vertex stands for; more tell no more

struct Tap {
  float x, y;
};
constexpr std::array<Tap, 8> kAround{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {0.7F, 0.7F}, {-0.7F, 0.7F}, {0.7F, -0.7F}, {-0.7F, -0.7F}}};

enum class Beside { same, before, behind };

// The vertex' tangent plane over the image.
struct Tangent {
  Eigen::Vector2f pixel;
  float inverse_m;
  Eigen::Vector2f slope;  // of inverse_m, a pixel

  [[nodiscard]] Beside look(const DepthImage& depth, const Eigen::Vector2f& towards) const {
    const Eigen::Vector2f at = (pixel + towards).array().round();
    const float drawn = depth.inverse_at(static_cast<int>(at.x()), static_cast<int>(at.y()));
    const float expected = inverse_m + slope.dot(at - pixel);
    if (drawn <= 0) return Beside::behind;
    if (expected <= 0) return Beside::before;  // the plane ends at its horizon; something stands there
    const float gap_m = 1 / expected - 1 / drawn;
    const float step_m = kStep_m + kStepPerDepth * std::abs(1 / expected - 1 / inverse_m);
    if (gap_m > step_m) return Beside::before;
    return gap_m < -step_m ? Beside::behind : Beside::same;
  }
};

}  // namespace

float sight_weight(const MeshVertex& vertex, const VertexSight& sighting, const Eigen::Matrix3f& R_camera_mesh,
                   const PinholeView& view, const DepthImage& depth, const SightLimits& limits, float weight_min) {
  if (!(sighting.inverse_m * limits.range_max_m > 1)) return 0;
  const Eigen::Vector2f& pixel = sighting.pixel;
  if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= static_cast<float>(view.width - 1) &&
        pixel.y() <= static_cast<float>(view.height - 1)))
    return 0;
  const Eigen::Vector2f bent = (pixel - view.centre_px) / view.focal_px;
  const Eigen::Vector3f ray(bent.x(), bent.y(), 1);
  const Eigen::Vector3f normal = R_camera_mesh * vertex.normal;
  const float along = normal.dot(ray);
  const float cosine = -along / ray.norm();
  if (!(cosine > kCosineMin)) return 0;
  const float width = width_px(sighting, view, limits);
  const float resolved = std::min(1.0F, width / kPixelsWanted);
  const float weight = cosine * resolved * resolved;  // if nothing hides it
  if (weight < weight_min) return 0;
  const Tangent tangent{pixel, sighting.inverse_m, sighting.inverse_m / (along * view.focal_px) * normal.head<2>()};
  if (tangent.look(depth, Eigen::Vector2f::Zero()) == Beside::before) return 0;
  const float margin = std::clamp(width / 2, kMargin_px, kMarginMax_px);
  bool rim = false;
  for (const Tap& tap : kAround) {
    const Beside beside = tangent.look(depth, margin * Eigen::Vector2f(tap.x, tap.y));
    if (beside == Beside::before) return 0;
    rim = rim || beside == Beside::behind;
  }
  return rim ? kRimWeight * weight : weight;
}

}  // namespace lxd
