// SPDX-License-Identifier: Apache-2.0
// The light that falls on a camera's pixels: a ray a pixel, several where something ends within it; global shutter.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/camera/camera_config.hpp"
#include "tools/simulator/camera/edge_sampler.hpp"
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
  void cast_centres(const View& view);
  void shade_centres(RadianceImage& image) const;
  void find_edges(const RadianceImage& image);
  void refine_edges(const View& view, RadianceImage& image);
  void store(const Eigen::Array3f& rgb, std::size_t pixel, RadianceImage& image) const;

  const Scene& scene_;
  const CameraConfig& config_;
  const RayTable& table_;
  CameraModel model_;
  EdgeSampler sampler_;
  Sights sights_;                     // of the pixels' centres
  std::vector<std::uint32_t> edges_;  // pixels in which something may end
};

}  // namespace lxd::sim
