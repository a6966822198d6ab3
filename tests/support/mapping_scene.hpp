// SPDX-License-Identifier: Apache-2.0
// A sub-mesh and its mesh in a test: storage, sampled surfaces, and what one asks of a mesh's edges.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "mapping/mesh_extraction.hpp"
#include "mapping/sub_mesh.hpp"

namespace lxd::test {

// An arena with its own block.
class OwnedArena {
 public:
  explicit OwnedArena(std::size_t bytes) : block_(bytes + Arena::kAlignment), arena_(aligned()) {}
  Arena& operator*() { return arena_; }

 private:
  std::span<std::byte> aligned() {
    const auto address = reinterpret_cast<std::uintptr_t>(block_.data());
    return std::span(block_).subspan((Arena::kAlignment - address % Arena::kAlignment) % Arena::kAlignment,
                                     block_.size() - Arena::kAlignment);
  }
  std::vector<std::byte> block_;
  Arena arena_;
};

inline constexpr SubMeshCapacity kSceneCapacity{4000, 6000, 4000, 400'000};
inline constexpr MeshCapacity kSceneMeshCapacity{6000, 200'000, 100'000, 200'000, 50'000};

// A sub-mesh that takes surfaces sampled with noise, seen from `sensor`.
class MappingScene {
 public:
  explicit MappingScene(const MappingConfig& config = {}, const SubMeshCapacity& capacity = kSceneCapacity,
                        const MeshCapacity& mesh_capacity = kSceneMeshCapacity)
      : arena_(std::size_t{24} << 20), sub_mesh(config, capacity, *arena_), extraction(config, mesh_capacity, *arena_) {
    sub_mesh.reset(Eigen::Vector3d::Zero(), RigTime::from_ns(0));
  }

  void add(const Eigen::Vector3f& p_m) { points_.push_back({p_m, sigma_m * sigma_m}); }

  // corner + a u + b v for a, b in a grid of `step_m` moved by chance within it, with noise along u x v.
  void add_patch(const Eigen::Vector3f& corner, const Eigen::Vector3f& u, const Eigen::Vector3f& v,
                 float step_m = 0.03F) {
    const int nu = static_cast<int>(u.norm() / step_m), nv = static_cast<int>(v.norm() / step_m);
    const Eigen::Vector3f normal = u.cross(v).normalized();
    std::uniform_real_distribution<float> within(0, 1);
    std::normal_distribution<float> noise(0, sigma_m);
    for (int i = 0; i < nu; ++i)
      for (int k = 0; k < nv; ++k) {
        const float a = (static_cast<float>(i) + within(random)) / static_cast<float>(nu);
        const float b = (static_cast<float>(k) + within(random)) / static_cast<float>(nv);
        add(corner + a * u + b * v + normal * noise(random));
      }
  }

  // What was added goes into the map, in chance order, as `sweeps` looks; none: a sweep that saw nothing.
  void fuse(const Eigen::Vector3f& sensor_m, int sweeps = 4) {
    if (sweeps == 0) {
      ++sweep_;
      return;
    }
    std::shuffle(points_.begin(), points_.end(), random);
    const std::size_t share = (points_.size() + sweeps - 1) / sweeps;
    for (std::size_t begin = 0; begin < points_.size(); begin += share)
      sub_mesh.insert(std::span(points_).subspan(begin, std::min(share, points_.size() - begin)),
                      Eigen::Vector3d::Zero(), sensor_m, sweep_++);
    points_.clear();
  }

  MeshExtraction::Mesh mesh() {
    NoBeams none;
    return extraction.extract(sub_mesh, none);
  }

  float sigma_m = 0.002F;
  std::mt19937 random{7};

 private:
  OwnedArena arena_;
  std::vector<MapPoint> points_;
  std::uint32_t sweep_ = 0;

 public:
  SubMesh sub_mesh;
  MeshExtraction extraction;
};

// What the edges of a mesh say about it.
struct MeshEdges {
  std::size_t interior = 0;
  std::size_t crowded = 0;      // with more than two faces
  std::size_t disagreeing = 0;  // two faces that run along it in the same direction
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
};

inline MeshEdges edges_of(const MeshExtraction::Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> uses;  // forwards, backwards
  for (const MeshFace& f : mesh.faces)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = f[k], b = f[(k + 1) % 3];
      auto& [forwards, backwards] = uses[std::minmax(a, b)];
      ++(a < b ? forwards : backwards);
    }
  MeshEdges out;
  for (const auto& [edge, use] : uses) {
    if (use.first + use.second == 1) out.open.push_back(edge);
    out.interior += use.first + use.second == 2;
    out.crowded += use.first + use.second > 2;
    out.disagreeing += use.first == 2 || use.second == 2;
  }
  return out;
}

// Connected parts, by shared vertices.
inline std::size_t components_of(const MeshExtraction::Mesh& mesh) {
  std::vector<std::uint32_t> root(mesh.vertices.size());
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = i;
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const MeshFace& f : mesh.faces) root[find(f[1])] = root[find(f[2])] = find(f[0]);
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < root.size(); ++i) count += root[i] == i;
  return count;
}

inline Eigen::Vector3f area_vector(const MeshExtraction::Mesh& mesh, const MeshFace& f) {
  const Eigen::Vector3f& a = mesh.vertices[f[0]].position_m;
  return 0.5F * (mesh.vertices[f[1]].position_m - a).cross(mesh.vertices[f[2]].position_m - a);
}

}  // namespace lxd::test
