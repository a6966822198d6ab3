// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace lxd::sim {
namespace {

constexpr int kSides = 12;
constexpr float kFar_m = 1e5F;

using Found = std::optional<std::string>;

Hit feel(const Scene& scene, const Eigen::Vector3d& at, const Eigen::Vector3d& direction, double range_m) {
  return scene.cast({.origin_m = at.cast<float>(),
                     .direction = direction.cast<float>(),
                     .range_max_m = static_cast<float>(range_m),
                     .movers = false});
}

const std::string& material_of(const Scene& scene, const Hit& hit) {
  return scene.world().materials[hit.material].name;
}

class Feeler {
 public:
  Feeler(const Scene& scene, const ClearanceRules& rules) : scene_(scene), rules_(rules) {
    for (const Eigen::Vector3f& vertex : scene.world().vertices) bounds_.extend(vertex.cast<double>());
    bounds_.max().z() += rules.headroom_m;
  }

  [[nodiscard]] Found wrong_at(const Eigen::Vector3d& at) const {
    if (!at.allFinite()) return "is not finite";
    if (!bounds_.contains(at)) return "leaves the world";
    const Hit below = feel(at, -Eigen::Vector3d::UnitZ(), kFar_m);
    if (rules_.needs_ground && !below.found()) return "has nothing below it";
    if (below.range_m < rules_.below_m) return near(below, "above");
    if (const Hit above = feel(at, Eigen::Vector3d::UnitZ(), rules_.radius_m); above.found())
      return near(above, "below");
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSides;
      const Hit side = feel(at, {std::cos(angle), std::sin(angle), 0}, rules_.radius_m);
      if (side.found()) return near(side, "from");
    }
    return std::nullopt;
  }

  [[nodiscard]] Found wrong_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    const Found surface = surface_between(scene_, from, to);
    if (!surface) return std::nullopt;
    return fmt::format("is behind {}, seen from the position before", *surface);
  }

 private:
  [[nodiscard]] Hit feel(const Eigen::Vector3d& at, const Eigen::Vector3d& direction, double range_m) const {
    return sim::feel(scene_, at, direction, range_m);
  }
  [[nodiscard]] std::string near(const Hit& hit, const char* relation) const {
    return fmt::format("is {:.2f} m {} {}", hit.range_m, relation, material_of(scene_, hit));
  }

  const Scene& scene_;
  const ClearanceRules& rules_;
  Eigen::AlignedBox3d bounds_;
};

}  // namespace

std::optional<std::string> surface_between(const Scene& scene, const Eigen::Vector3d& from_m,
                                           const Eigen::Vector3d& to_m) {
  const double length_m = (to_m - from_m).norm();
  if (length_m == 0) return std::nullopt;
  const Hit hit = feel(scene, from_m, (to_m - from_m) / length_m, length_m);
  if (!hit.found()) return std::nullopt;
  return material_of(scene, hit);
}

std::optional<Collision> first_collision(const Scene& scene, std::span<const Eigen::Vector3d> path_m,
                                         const ClearanceRules& rules) {
  const Feeler feeler(scene, rules);
  std::size_t last = 0;
  for (std::size_t i = 0; i < path_m.size(); ++i) {
    const bool end = i == 0 || i + 1 == path_m.size();
    if (!end && (path_m[i] - path_m[last]).norm() < rules.sample_m) continue;
    Found wrong = feeler.wrong_at(path_m[i]);
    if (!wrong && i > 0) wrong = feeler.wrong_between(path_m[last], path_m[i]);
    if (wrong) return Collision{i, *wrong};
    last = i;
  }
  return std::nullopt;
}

}  // namespace lxd::sim
