// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "tools/simulator/camera/motion_blur.hpp"
#include "tools/simulator/camera/shading.hpp"

namespace lxd::sim {
namespace {

// A rotated grid within the pixel: no two samples share a row or a column.
constexpr std::array<std::array<float, 2>, 4> kWithinPixel{
    {{-0.125F, -0.375F}, {0.375F, -0.125F}, {-0.375F, 0.125F}, {0.125F, 0.375F}}};
constexpr std::size_t kEdgesAtOnce = 1024;
constexpr float kCrease = 0.95F;    // cosine between normals that meet in an edge
constexpr float kOffPlane = 0.01F;  // of the range: the neighbour lies on another surface
constexpr int kMeter_px = 40;       // between the pixels that the exposure control looks at

}  // namespace

Renderer::Renderer(const Scene& scene, const CameraConfig& config, const RayTable& rays)
    : scene_(scene), config_(config), table_(rays), model_(intrinsics_of(config)) {}

void Renderer::render(const Trajectory& motion, double begin_s, double exposure_s, RadianceImage& image) {
  const auto T_world_camera = [&](double t_s) { return motion.at(t_s).T_world_body * config_.T_body_sensor; };
  const double middle_s = begin_s + exposure_s / 2;
  const Pose T_world_middle = T_world_camera(middle_s);
  render(T_world_middle, middle_s, image);
  if (!config_.motion_blur) return;
  const ExposureMotion moved{T_world_camera(begin_s).inverse() * T_world_middle,
                             T_world_camera(begin_s + exposure_s).inverse() * T_world_middle};
  blur(model_, table_, moved, image);
}

void Renderer::render(const Pose& T_world_camera, double t_s, RadianceImage& image) {
  image.resize(table_.width(), table_.height(), config_.colour ? 3 : 1);
  const View view{T_world_camera.R.cast<float>(), T_world_camera.p.cast<float>(), static_cast<float>(t_s)};
  cast_centres(view);
  shade_centres(image);
  find_edges(image);
  refine_edges(view, image);
}

double Renderer::metered(const Pose& T_world_camera, double t_s) {
  const View view{T_world_camera.R.cast<float>(), T_world_camera.p.cast<float>(), static_cast<float>(t_s)};
  rays_.clear();
  for (int v = 0; v < table_.height(); v += kMeter_px) {
    for (int u = 0; u < table_.width(); u += kMeter_px) rays_.push_back(ray_of(view, table_.at(u, v)));
  }
  hits_.resize(rays_.size());
  scene_.cast(rays_, hits_);
  double sum = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i)
    sum += std::min(1.0F, luminance(radiance(scene_.world(), hits_[i], rays_[i].direction)));
  return sum / static_cast<double>(rays_.size());
}

Ray Renderer::ray_of(const View& view, const Eigen::Vector3f& direction_camera) const {
  Ray ray;
  ray.origin_m = view.p_world;
  ray.direction = view.R_world_camera * direction_camera;
  ray.t_s = view.t_s;
  ray.spread_rad = table_.spread_rad();
  return ray;
}

void Renderer::cast_centres(const View& view) {
  rays_.clear();
  for (int v = 0; v < table_.height(); ++v) {
    for (int u = 0; u < table_.width(); ++u) rays_.push_back(ray_of(view, table_.at(u, v)));
  }
  hits_.resize(rays_.size());
  scene_.cast(rays_, hits_);
}

void Renderer::store(const Eigen::Array3f& rgb, std::size_t pixel, RadianceImage& image) const {
  if (image.channels == 1) {
    image.radiance[pixel] = luminance(rgb);
  } else {
    std::copy_n(rgb.data(), 3, &image.radiance[3 * pixel]);
  }
}

void Renderer::shade_centres(RadianceImage& image) const {
  for (std::size_t pixel = 0; pixel < hits_.size(); ++pixel) {
    image.range_m[pixel] = hits_[pixel].range_m;
    store(radiance(scene_.world(), hits_[pixel], rays_[pixel].direction), pixel, image);
  }
}

bool Renderer::ends_between(std::size_t pixel, std::size_t neighbour) const {
  const Hit &a = hits_[pixel], &b = hits_[neighbour];
  if (!a.found() || !b.found()) return a.found() != b.found();
  if (a.material != b.material || a.mover != b.mover || a.normal.dot(b.normal) < kCrease) return true;
  const Eigen::Vector3f apart = b.range_m * rays_[neighbour].direction - a.range_m * rays_[pixel].direction;
  return std::abs(apart.dot(a.normal)) > kOffPlane * a.range_m;
}

// Both sides of an end are edges: it lies in one of the two pixels.
void Renderer::find_edges(const RadianceImage& image) {
  edges_.clear();
  std::vector<bool> found(hits_.size(), false);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const std::size_t here = image.index(u, v);
      if (u + 1 < image.width && ends_between(here, here + 1)) found[here] = found[here + 1] = true;
      const std::size_t below = here + static_cast<std::size_t>(image.width);
      if (v + 1 < image.height && ends_between(here, below)) found[here] = found[below] = true;
    }
  }
  for (std::size_t pixel = 0; pixel < found.size(); ++pixel) {
    if (found[pixel]) edges_.push_back(static_cast<std::uint32_t>(pixel));
  }
}

void Renderer::refine_edges(const View& view, RadianceImage& image) {
  const auto width = static_cast<std::uint32_t>(image.width);
  std::span<const std::uint32_t> left(edges_);
  while (!left.empty()) {
    const auto now = left.first(std::min(kEdgesAtOnce, left.size()));
    left = left.subspan(now.size());
    fine_rays_.clear();
    for (const std::uint32_t pixel : now) {
      const int u = static_cast<int>(pixel % width), v = static_cast<int>(pixel / width);
      for (const auto& [du, dv] : kWithinPixel) fine_rays_.push_back(ray_of(view, table_.beside(u, v, du, dv)));
    }
    fine_hits_.resize(fine_rays_.size());
    scene_.cast(fine_rays_, fine_hits_);
    for (std::size_t i = 0; i < now.size(); ++i) {
      Eigen::Array3f sum = Eigen::Array3f::Zero();
      for (std::size_t k = kWithinPixel.size() * i; k < kWithinPixel.size() * (i + 1); ++k)
        sum += radiance(scene_.world(), fine_hits_[k], fine_rays_[k].direction);
      store(sum / static_cast<float>(kWithinPixel.size()), now[i], image);
    }
  }
}

}  // namespace lxd::sim
