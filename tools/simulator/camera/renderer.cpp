// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/renderer.hpp"

#include <algorithm>
#include <span>

#include "tools/simulator/camera/motion_blur.hpp"
#include "tools/simulator/camera/shading.hpp"

namespace lxd::sim {
namespace {

constexpr std::size_t kEdgesAtOnce = 1024;
constexpr int kMeter_px = 40;  // between the pixels that the exposure control looks at

}  // namespace

Renderer::Renderer(const Scene& scene, const CameraConfig& config, const RayTable& rays)
    : scene_(scene), config_(config), table_(rays), model_(intrinsics_of(config)), sampler_(scene, rays) {}

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
  const View view(T_world_camera, t_s, table_.spread_rad());
  cast_centres(view);
  shade_centres(image);
  find_edges(image);
  refine_edges(view, image);
}

double Renderer::metered(const Pose& T_world_camera, double t_s) {
  const View view(T_world_camera, t_s, table_.spread_rad());
  sights_.rays.clear();
  for (int v = 0; v < table_.height(); v += kMeter_px) {
    for (int u = 0; u < table_.width(); u += kMeter_px) sights_.rays.push_back(view.ray(table_.at(u, v)));
  }
  sights_.cast(scene_);
  double sum = 0;
  for (std::size_t i = 0; i < sights_.rays.size(); ++i)
    sum += std::min(1.0F, luminance(radiance(scene_.world(), sights_.hits[i], sights_.rays[i].direction)));
  return sum / static_cast<double>(sights_.rays.size());
}

void Renderer::cast_centres(const View& view) {
  sights_.rays.clear();
  for (int v = 0; v < table_.height(); ++v) {
    for (int u = 0; u < table_.width(); ++u) sights_.rays.push_back(view.ray(table_.at(u, v)));
  }
  sights_.cast(scene_);
}

void Renderer::store(const Eigen::Array3f& rgb, std::size_t pixel, RadianceImage& image) const {
  if (image.channels == 1) {
    image.radiance[pixel] = luminance(rgb);
  } else {
    std::copy_n(rgb.data(), 3, &image.radiance[3 * pixel]);
  }
}

void Renderer::shade_centres(RadianceImage& image) const {
  for (std::size_t pixel = 0; pixel < sights_.hits.size(); ++pixel) {
    image.range_m[pixel] = sights_.hits[pixel].range_m;
    store(radiance(scene_.world(), sights_.hits[pixel], sights_.rays[pixel].direction), pixel, image);
  }
}

// Both sides of an end are edges: it lies in one of the two pixels.
void Renderer::find_edges(const RadianceImage& image) {
  edges_.clear();
  std::vector<bool> found(sights_.hits.size(), false);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const std::size_t here = image.index(u, v);
      if (u + 1 < image.width && differ(sights_, here, sights_, here + 1)) found[here] = found[here + 1] = true;
      const std::size_t below = here + static_cast<std::size_t>(image.width);
      if (v + 1 < image.height && differ(sights_, here, sights_, below)) found[here] = found[below] = true;
    }
  }
  for (std::size_t pixel = 0; pixel < found.size(); ++pixel) {
    if (found[pixel]) edges_.push_back(static_cast<std::uint32_t>(pixel));
  }
}

void Renderer::refine_edges(const View& view, RadianceImage& image) {
  std::span<const std::uint32_t> left(edges_);
  while (!left.empty()) {
    const auto now = left.first(std::min(kEdgesAtOnce, left.size()));
    left = left.subspan(now.size());
    for (const EdgeSampler::Result& result : sampler_.sample(view, sights_, now))
      store(result.radiance, result.pixel, image);
  }
}

}  // namespace lxd::sim
