// SPDX-License-Identifier: Apache-2.0
#include "backend/colour/depth_image.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

constexpr float kDrawnFrom_m =
    0.05F;  // faces with a corner nearer than this are the carrier itself, or beside the image

float turn_of(const Eigen::Vector2f& a, const Eigen::Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

DepthImage::DepthImage(const PinholeView& view) : width_(view.width), height_(view.height), inverse_(view.pixels()) {}

void DepthImage::draw(std::span<const VertexSight> sightings, std::span<const MeshFace> faces) {
  for (const MeshFace& face : faces) draw(sightings[face[0]], sightings[face[1]], sightings[face[2]]);
}

// The inverse depth of a plane is linear over the image.
void DepthImage::draw(const VertexSight& a, const VertexSight& b, const VertexSight& c) {
  if (!(a.inverse_m > 0 && b.inverse_m > 0 && c.inverse_m > 0)) return;
  const Eigen::Vector2f low = a.pixel.cwiseMin(b.pixel).cwiseMin(c.pixel),
                        high = a.pixel.cwiseMax(b.pixel).cwiseMax(c.pixel);
  const auto right = static_cast<float>(width_ - 1), below = static_cast<float>(height_ - 1);
  if (!(low.x() <= right && low.y() <= below && high.x() >= 0 && high.y() >= 0)) return;
  const Eigen::Vector2f ab = b.pixel - a.pixel, ac = c.pixel - a.pixel;
  const float doubled_area = turn_of(ab, ac);
  if (doubled_area == 0 || !std::isfinite(doubled_area)) return;
  const int x0 = static_cast<int>(std::ceil(std::max(0.0F, low.x()))), x1 = static_cast<int>(std::min(right, high.x())),
            y0 = static_cast<int>(std::ceil(std::max(0.0F, low.y()))), y1 = static_cast<int>(std::min(below, high.y()));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector2f p = Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - a.pixel;
      const float u = turn_of(p, ac) / doubled_area, v = turn_of(ab, p) / doubled_area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      float& nearest = inverse_[static_cast<std::size_t>(y) * width_ + x];
      nearest = std::max(nearest, a.inverse_m + u * (b.inverse_m - a.inverse_m) + v * (c.inverse_m - a.inverse_m));
    }
  }
}

void sight(std::span<const MeshVertex> vertices, const Pose& T_camera_mesh, const PinholeView& view,
           std::span<VertexSight> sightings) {
  const Eigen::Matrix3f R = T_camera_mesh.R.cast<float>();
  const Eigen::Vector3f t = T_camera_mesh.p.cast<float>();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3f p = R * vertices[i].position_m + t;
    sightings[i] = p.z() > kDrawnFrom_m ? VertexSight{view.pixel(p), 1 / p.z()} : VertexSight{};
  }
}

}  // namespace lxd
