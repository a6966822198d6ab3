// SPDX-License-Identifier: Apache-2.0
// Rasterisation by barycentric coordinates over the bounding box.
#include "backend/overview_raster.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Box {
  int x0, x1, y0, y1;  // inclusive
};

Box box_of(const std::array<Raster::Corner, 3>& c, int width, int height) {
  const Eigen::Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]);
  const Eigen::Vector3d high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
  const auto pixel = [](double at, int size) {
    return static_cast<int>(std::clamp(at, -1.0, static_cast<double>(size)));
  };
  return {std::max(pixel(std::floor(low.x()), width), 0), std::min(pixel(std::ceil(high.x()), width), width - 1),
          std::max(pixel(std::floor(low.y()), height), 0), std::min(pixel(std::ceil(high.y()), height), height - 1)};
}

}  // namespace

Raster::Raster(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      depth_(static_cast<std::size_t>(width_px) * height_px, kNothing),
      colour_(depth_.size(), Pixel{}) {}

Raster::Pixel Raster::packed(const Colour& colour) {
  const auto level = [](float share) {
    return static_cast<std::uint8_t>(255.0F * std::clamp(share, 0.0F, 1.0F) + 0.5F);
  };
  return {level(colour.x()), level(colour.y()), level(colour.z())};
}

void Raster::put(int x, int y, double depth_m, const Colour& colour) {
  const std::size_t i = index(x, y);
  if (depth_[i] >= static_cast<float>(depth_m)) return;
  depth_[i] = static_cast<float>(depth_m);
  colour_[i] = packed(colour);
}

void Raster::triangle(const std::array<Corner, 3>& c, const std::array<Colour, 3>& colours) {
  const Eigen::Vector2d ab = (c[1] - c[0]).head<2>(), ac = (c[2] - c[0]).head<2>();
  const double doubled_area = cross(ab, ac);
  if (!std::isfinite(doubled_area) || doubled_area == 0) return;
  const Box box = box_of(c, width_px_, height_px_);
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x) {
      const Eigen::Vector2d p = Eigen::Vector2d(x + 0.5, y + 0.5) - c[0].head<2>();
      const double u = cross(p, ac) / doubled_area, v = cross(ab, p) / doubled_area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      const auto uf = static_cast<float>(u), vf = static_cast<float>(v);
      put(x, y, c[0].z() + u * (c[1].z() - c[0].z()) + v * (c[2].z() - c[0].z()),
          colours[0] + uf * (colours[1] - colours[0]) + vf * (colours[2] - colours[0]));
    }
}

void Raster::line(const Corner& a, const Corner& b, const Colour& colour) {
  constexpr double kLongest_px = 1e4;  // anything longer is a stray vertex
  const double length_px = (b - a).head<2>().cwiseAbs().maxCoeff();
  if (!(length_px < kLongest_px)) return;
  const int steps = std::max(static_cast<int>(std::ceil(length_px)), 1);
  for (int i = 0; i <= steps; ++i) {
    const Corner at = a + (b - a) * (static_cast<double>(i) / steps);
    const bool inside = at.x() >= 0 && at.x() < width_px_ && at.y() >= 0 && at.y() < height_px_;
    if (inside) put(static_cast<int>(at.x()), static_cast<int>(at.y()), at.z(), colour);
  }
}

// Mean over the neighbours of how much nearer to the eye they are, in m; uncovered neighbours count as level.
float Raster::depth_step(int x, int y) const {
  constexpr int kRadius_px = 3;
  constexpr float kStepMax_m = 2;
  float sum = 0;
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {-1, 1}, {1, -1}}) {
    const int nx = std::clamp(x + kRadius_px * dx, 0, width_px_ - 1),
              ny = std::clamp(y + kRadius_px * dy, 0, height_px_ - 1);
    if (covered(nx, ny)) sum += std::clamp(depth_[index(nx, ny)] - depth_[index(x, y)], 0.F, kStepMax_m);
  }
  constexpr float kNeighbours = 8;
  return sum / kNeighbours;
}

void Raster::shade_by_depth(double strength_per_m) {
  const auto strength = static_cast<float>(strength_per_m);
  for (int y = 0; y < height_px_; ++y)
    for (int x = 0; x < width_px_; ++x)
      if (covered(x, y)) colour_[index(x, y)] = packed(colour(x, y) * std::exp(-strength * depth_step(x, y)));
}

}  // namespace lxd
