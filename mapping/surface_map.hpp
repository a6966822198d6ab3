// SPDX-License-Identifier: Apache-2.0
// The ring of local sub-meshes (paper, "Bounded Computational Complexity Sub-Mesh Management"): new points go into the
// youngest, queries ask the oldest first, because its surfaces carry the least drift. Each sub-mesh has its surfaces
// twice: in fine cells, which become the mesh, and in coarse ones, which hold a surface already where a sparse LiDAR's
// scan lines lie metres apart; queries turn to them where the fine cells have nothing. When the way driven or the fill
// of the youngest asks for a new one, the oldest leaves the window and waits to be collected: constant time, no copy.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "mapping/config.hpp"
#include "mapping/sub_mesh.hpp"
#include "rt/arena.hpp"
#include "rt/time.hpp"

namespace lxd {

// Nearest surface to a point: n^T p + d of the paper is `distance_m`.
struct SurfaceHit {
  float distance_m;        // signed, positive on the side of the normal
  float variance_m2;       // sigma_mesh^2 along the normal
  Eigen::Vector3f normal;  // unit, world axes
};

// A registered sweep on its way into the map. Positions are relative to origin_world, axes of the world.
struct MapSweep {
  std::span<const MapPoint> points;          // all of them, for the fine cells
  std::span<const MapPoint> thinned_points;  // thinned by space, for the coarse cells
  Eigen::Vector3d origin_world_m;
  Eigen::Vector3f sensor_m;  // where the LiDAR was at the sweep's end
  RigTime stamp;
};

inline constexpr int kSubMeshWindow = 3;                  // sub-meshes that answer queries
inline constexpr int kSubMeshCount = kSubMeshWindow + 1;  // and one that the back-end may hold

struct SurfaceMapCapacity {
  SubMeshCapacity fine, coarse;  // of each sub-mesh
};

class SurfaceMap {
 public:
  SurfaceMap(const MappingConfig& config, const SurfaceMapCapacity& capacity, Arena& arena);

  void clear();

  // Fuses one registered sweep and begins a new sub-mesh when one is due.
  void insert(const MapSweep& sweep) noexcept;

  // beam: unit, from the LiDAR to the point, or zero: surfaces whose back it would meet are not the point's. The two
  // sides of a wall are different surfaces.
  [[nodiscard]] bool nearest(const Eigen::Vector3d& p_world_m, SurfaceHit& hit,
                             const Eigen::Vector3f& beam = Eigen::Vector3f::Zero()) const noexcept;

  // The sub-mesh that has left the window and waits for the back-end; nullptr: none. Until release_retired() is called
  // it stays as it is; one that leaves the window before that is lost and counted.
  [[nodiscard]] const SubMesh* retired() const { return retired_ == kNone ? nullptr : &fine_[retired_]; }
  void release_retired() { retired_ = kNone; }
  [[nodiscard]] std::uint64_t lost_sub_meshes() const { return lost_; }

  // Window, oldest first: window(0) .. window(window_size() - 1).
  [[nodiscard]] std::uint32_t window_size() const { return window_size_; }
  [[nodiscard]] const SubMesh& window(std::uint32_t i) const { return fine_[order_[i]]; }
  [[nodiscard]] const SubMesh& coarse_window(std::uint32_t i) const { return coarse_[order_[i]]; }
  [[nodiscard]] bool empty() const { return window_size_ == 0; }
  [[nodiscard]] const MappingConfig& config() const { return config_; }

 private:
  void begin_sub_mesh(const Eigen::Vector3d& near_world_m, RigTime stamp);
  void retire_oldest();
  [[nodiscard]] bool new_one_is_due() const;
  bool nearest_at(const std::array<SubMesh, kSubMeshCount>& level, double cell_size_m, const Eigen::Vector3d& p_world_m,
                  const Eigen::Vector3f& beam, SurfaceHit& hit) const;

  MappingConfig config_;
  std::array<SubMesh, kSubMeshCount> fine_, coarse_;
  std::array<std::uint32_t, kSubMeshCount> order_{0, 1, 2, 3};  // of storage: the window, oldest first, then the rest
  std::uint32_t window_size_ = 0, retired_ = kNone, sweep_ = 0;
  std::uint64_t lost_ = 0;
  double path_m_ = 0;  // driven since the youngest began
  Eigen::Vector3d last_position_m_ = Eigen::Vector3d::Zero();
};

}  // namespace lxd
