// SPDX-License-Identifier: Apache-2.0
// What the loop finder remembers: places with their descriptors, and the surfaces of their sub-meshes. Bounded: too
// many places are thinned out evenly, of too many surfaces the oldest sub-mesh's are given up (and may be fetched
// again).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "backend/loops/packed_surfel.hpp"
#include "backend/loops/place_index.hpp"
#include "backend/loops/scan_context.hpp"
#include "backend/loops/surfels.hpp"
#include "rt/pose.hpp"

namespace lxd {

struct LoopPlace {
  std::int64_t id = 0;         // of the key frame
  std::uint32_t submesh = 0;   // ordinal, in order of addition
  std::optional<int> earlier;  // of the map of this number, whose frame is another one than this path's world
  bool pose_known = true;
  Pose T_submesh_body;
  Eigen::Vector3d p_world_m = Eigen::Vector3d::Zero();  // earlier: in the frame of its map
  double path_m = 0;
  ScanContext context;
  RingKey key{};
};

struct PlaceMemoryConfig {
  std::size_t places_max = 8192;        // 5 kB each
  std::size_t surfels_max = 8'000'000;  // 10 B each
};

// Fills in the vertices of a sub-mesh by its id, from the archive; false: it has none such.
using SubmeshSource = std::function<bool(std::int64_t id, std::vector<MeshVertex>& vertices)>;

class PlaceMemory {
 public:
  PlaceMemory(const PlaceMemoryConfig& config, const ThinningConfig& thinning) : config_(config), thinning_(thinning) {}

  void set_source(SubmeshSource source) { source_ = std::move(source); }

  std::uint32_t add_submesh(std::int64_t id, std::span<const Surfel> surfels);
  void add_place(const LoopPlace& place);

  [[nodiscard]] std::span<const LoopPlace> places() const { return places_; }
  [[nodiscard]] std::span<LoopPlace> places() { return places_; }  // keys must stay as they are
  [[nodiscard]] const PlaceIndex& index() const { return index_; }
  [[nodiscard]] std::optional<std::vector<Surfel>> surfaces(std::uint32_t submesh) const;
  [[nodiscard]] std::uint64_t forgotten() const { return forgotten_; }  // places
  [[nodiscard]] std::size_t bytes() const;                              // of places and surfaces

 private:
  struct Surfaces {
    std::int64_t id = 0;
    std::vector<PackedSurfel> surfels;
  };
  void thin_out();

  PlaceMemoryConfig config_;
  ThinningConfig thinning_;
  SubmeshSource source_;
  std::vector<LoopPlace> places_;
  PlaceIndex index_;  // of positions in places_
  std::vector<Surfaces> submeshes_;
  std::size_t surfels_ = 0;
  std::size_t oldest_kept_ = 0;  // sub-meshes before it have given up their surfaces
  std::uint64_t forgotten_ = 0;
};

}  // namespace lxd
