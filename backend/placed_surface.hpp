// SPDX-License-Identifier: Apache-2.0
// One sub-mesh's surface, asked by place: what a point that lies on it has of it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "backend/archive.hpp"
#include "backend/cloud.hpp"
#include "rt/pose.hpp"
#include "rt/time.hpp"

namespace lxd {

// A sub-mesh of the archive, where the cloud has it.
struct PlacedSubmesh {
  RigTime begin;
  std::int64_t id = 0;
  Pose T_cloud_submesh;
};

// Vertices lie in memory by hash of cells twice the radius wide, so that eight of them hold all that is near.
class PlacedSurface {
 public:
  explicit PlacedSurface(double radius_m) : radius_m_(static_cast<float>(radius_m)) {}

  // Empty where the archive has none such, or it is damaged.
  void load(const Archive& archive, const PlacedSubmesh& submesh, bool coloured);

  // Gives the point the surface within the radius, if there is any: normal and variance of the nearest vertex, and the
  // colour of those around that show the same side, the nearer the more. Of the two sides of a sheet the one is meant
  // that shows to `eye`, where the point was seen from (cloud's frame).
  void tell(CloudPoint& point, const std::optional<Eigen::Vector3d>& eye);

 private:
  using Place = std::array<std::int32_t, 3>;
  struct Near {
    std::uint32_t vertex;
    float squared_m2;
  };

  [[nodiscard]] Place cell_of_place(const Eigen::Vector3f& p, float shift) const;
  [[nodiscard]] std::size_t slot_of(const Place& place) const;
  [[nodiscard]] std::size_t slot_of_vertex(std::size_t vertex) const;
  void count_slots();
  void sort_by_slot();
  void gather(const Eigen::Vector3f& p);
  void gather(const Eigen::Vector3f& p, std::size_t slot);
  void keep_shown_to(const Eigen::Vector3f& ray);
  [[nodiscard]] VertexColour colour_around(const Eigen::Vector3f& normal) const;

  float radius_m_;
  Pose T_cloud_submesh_, T_submesh_cloud_;
  std::vector<MeshVertex> vertices_;     // slot by slot
  std::vector<VertexColour> colours_;    // one a vertex, or none
  std::vector<std::uint32_t> begins_;    // of each slot's vertices, and the end of the last
  std::vector<std::uint32_t> unsorted_;  // of each slot, while they are sorted
  std::vector<Near> near_;               // around the point in question
};

}  // namespace lxd
