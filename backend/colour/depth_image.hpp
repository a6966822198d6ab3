// SPDX-License-Identifier: Apache-2.0
// How far a mesh is in each pixel of a key image: what a camera cannot see through.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "backend/colour/key_image.hpp"
#include "mapping/mesh.hpp"

namespace lxd {

// Where a vertex lies in an image; inverse_m is 0 for what is behind the camera.
struct VertexSight {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  float inverse_m = 0;  // of the depth along the camera's axis
};

class DepthImage {
 public:
  explicit DepthImage(const PinholeView& view);

  // Faces, whichever side they show, before what is there. sightings: of the mesh's vertices.
  void draw(std::span<const VertexSight> sightings, std::span<const MeshFace> faces);

  // One over the depth of the nearest surface, 1/m; 0: none, or off the image.
  [[nodiscard]] float inverse_at(int x, int y) const {
    return x < 0 || y < 0 || x >= width_ || y >= height_ ? 0.0F : inverse_[static_cast<std::size_t>(y) * width_ + x];
  }

 private:
  void draw(const VertexSight& a, const VertexSight& b, const VertexSight& c);

  int width_, height_;
  std::vector<float> inverse_;
};

// One a vertex. p_camera = T_camera_mesh p.
void sight(std::span<const MeshVertex> vertices, const Pose& T_camera_mesh, const PinholeView& view,
           std::span<VertexSight> sightings);

}  // namespace lxd
