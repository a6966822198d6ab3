// SPDX-License-Identifier: Apache-2.0
// One sub-mesh's surface, asked by place: what a point that lies on it has of it.
#pragma once

#include <array>
#include <cstdint>
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
  // colour of those around that show the same side, the nearer the more. `eyes`: where the sensors were (cloud's
  // frame), one of which saw the point; none: unknown. Of the two sides of a sheet the one is meant that shows to
  // them; what shows away and stands alone is turned.
  void tell(CloudPoint& point, std::span<const Eigen::Vector3d> eyes);

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
  [[nodiscard]] bool averted(const Near& near) const;
  const Near& nearest_shown();
  [[nodiscard]] VertexColour colour_around(const Eigen::Vector3f& normal) const;

  float radius_m_;
  Pose T_cloud_submesh_, T_submesh_cloud_;
  std::vector<MeshVertex> vertices_;     // slot by slot
  std::vector<VertexColour> colours_;    // one a vertex, or none
  std::vector<std::uint32_t> begins_;    // of each slot's vertices, and the end of the last
  std::vector<std::uint32_t> unsorted_;  // of each slot, while they are sorted
  std::vector<Near> near_;               // around the point in question
  std::vector<Eigen::Vector3f> rays_;    // from it to the eyes, unit
};

}  // namespace lxd
