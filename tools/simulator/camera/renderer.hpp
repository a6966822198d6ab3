// SPDX-License-Identifier: Apache-2.0
// The light that falls on a camera's pixels: a ray a pixel, several where something ends within it; global shutter.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/simulator/camera/camera_config.hpp"
#include "tools/simulator/camera/radiance_image.hpp"
#include "tools/simulator/camera/ray_table.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/world/scene.hpp"

namespace lxd::sim {

// One a thread: it keeps its working memory. Scene, table and config must outlive it.
class Renderer {
 public:
  Renderer(const Scene& scene, const CameraConfig& config, const RayTable& rays);

  // An instant: sharp. range_m is that of each pixel's centre.
  void render(const Pose& T_world_camera, double t_s, RadianceImage& image);

  // An exposure, smeared by the camera's motion unless the config has no blur. Times since the recording's start.
  void render(const Trajectory& motion, double begin_s, double exposure_s, RadianceImage& image);

  // Mean luminance of a sparse grid of pixels, each at most as bright as white: what a camera's control looks at.
  [[nodiscard]] double metered(const Pose& T_world_camera, double t_s);

 private:
  struct View {
    Eigen::Matrix3f R_world_camera;
    Eigen::Vector3f p_world;
    float t_s;
  };
  [[nodiscard]] Ray ray_of(const View& view, const Eigen::Vector3f& direction_camera) const;
  void cast_centres(const View& view);
  void shade_centres(RadianceImage& image) const;
  [[nodiscard]] static bool differ(const Ray& ray_a, const Hit& a, const Ray& ray_b, const Hit& b);
  [[nodiscard]] bool ends_between(std::size_t pixel, std::size_t neighbour) const;
  void find_edges(const RadianceImage& image);
  void refine_edges(const View& view, RadianceImage& image);
  template <typename OffsetsOf>
  void cast_within(const View& view, std::span<const std::uint32_t> pixels, OffsetsOf offsets_of);
  [[nodiscard]] bool splits(std::size_t pixel, std::size_t i) const;
  [[nodiscard]] Eigen::Array3f mean_of_lattice(std::size_t i) const;
  void store(const Eigen::Array3f& rgb, std::size_t pixel, RadianceImage& image) const;

  const Scene& scene_;
  const CameraConfig& config_;
  const RayTable& table_;
  CameraModel model_;
  std::vector<Ray> rays_;  // as the pixels
  std::vector<Hit> hits_;
  std::vector<std::uint32_t> edges_;  // pixels in which something may end
  std::vector<std::uint32_t> split_;  // those in which something does
  std::vector<Ray> fine_rays_;
  std::vector<Hit> fine_hits_;
};

}  // namespace lxd::sim
