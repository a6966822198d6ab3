// SPDX-License-Identifier: Apache-2.0
// A map in a test that rays are cast into: sampled rectangles, some looks at them, and rays against triangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "mapping/ray_cast.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::test {

class CastScene {
 public:
  explicit CastScene(const MappingConfig& config = {})
      : arena_(std::size_t{48} << 20), map(config, {kCapacity, kCapacity}, *arena_) {}

  // corner + a u + b v, a and b in 0..1, one return a `step_m`, moved by chance within it.
  void add_patch(const Eigen::Vector3f& corner, const Eigen::Vector3f& u, const Eigen::Vector3f& v,
                 float step_m = 0.04F) {
    const int nu = static_cast<int>(u.norm() / step_m), nv = static_cast<int>(v.norm() / step_m);
    const Eigen::Vector3f normal = u.cross(v).normalized();
    std::uniform_real_distribution<float> within(0, 1);
    std::normal_distribution<float> noise(0, kSigma_m);
    for (int i = 0; i < nu; ++i)
      for (int k = 0; k < nv; ++k) {
        const float a = (static_cast<float>(i) + within(random)) / static_cast<float>(nu);
        const float b = (static_cast<float>(k) + within(random)) / static_cast<float>(nv);
        points_.push_back({corner + a * u + b * v + normal * noise(random), kSigma_m * kSigma_m});
      }
  }

  // The inside of low..high, all six faces but the ceiling's.
  void add_room(const Eigen::Vector3f& low, const Eigen::Vector3f& size) {
    const Eigen::Vector3f x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
    add_patch(low, x, y);
    add_patch(low, x, z);
    add_patch(low, y, z);
    add_patch(low + y, x, z);
    add_patch(low + x, y, z);
  }

  // What was added goes into the map as some looks from there; the coarse cells take every `thin`-th, 0: none.
  void fuse(const Eigen::Vector3f& sensor_m, std::size_t thin = 0) {
    std::shuffle(points_.begin(), points_.end(), random);
    std::vector<MapPoint> thinned;
    for (std::size_t i = 0; thin > 0 && i < points_.size(); i += thin) thinned.push_back(points_[i]);
    constexpr std::size_t kLooks = 4;
    for (std::size_t k = 0; k < kLooks; ++k)
      map.insert({share(points_, k, kLooks), share(thinned, k, kLooks), Eigen::Vector3d::Zero(), sensor_m,
                  RigTime::from_ns(++stamp_)});
    points_.clear();
  }

  static constexpr float kSigma_m = 0.002F;
  std::mt19937 random{11};

 private:
  static constexpr SubMeshCapacity kCapacity{6000, 8000, 4000, 400'000};

  static std::span<const MapPoint> share(const std::vector<MapPoint>& all, std::size_t k, std::size_t of) {
    return std::span(all).subspan(all.size() * k / of, all.size() * (k + 1) / of - all.size() * k / of);
  }

  OwnedArena arena_;
  std::vector<MapPoint> points_;
  std::int64_t stamp_ = 0;

 public:
  SurfaceMap map;
};

// Moeller & Trumbore 1997, both sides; infinite: missed.
inline double triangle_distance(const Ray& ray, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
  const Eigen::Vector3d e1 = b - a, e2 = c - a, p = ray.direction.cross(e2);
  const double det = e1.dot(p);
  const Eigen::Vector3d s = (ray.origin_m - a) / det, q = s.cross(e1);
  const double u = s.dot(p), v = ray.direction.dot(q), t = e2.dot(q);
  const bool hit = u >= 0 && v >= 0 && u + v <= 1 && t >= 0;
  return hit ? t : std::numeric_limits<double>::infinity();
}

inline double mesh_distance(const Ray& ray, const MeshExtraction::Mesh& mesh, const Eigen::Vector3d& origin_m) {
  double best = std::numeric_limits<double>::infinity();
  const auto at = [&](std::uint32_t i) -> Eigen::Vector3d {
    return mesh.vertices[i].position_m.cast<double>() + origin_m;
  };
  for (const MeshFace& f : mesh.faces) best = std::min(best, triangle_distance(ray, at(f[0]), at(f[1]), at(f[2])));
  return best;
}

}  // namespace lxd::test
