// SPDX-License-Identifier: Apache-2.0
// A room without a ceiling, a carrier that walks and turns in it, and the features that its camera would see, told by
// geometry alone.
#pragma once

#include <cmath>
#include <vector>

#include "estimator/vision/feature_store.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/cast_scene.hpp"
#include "tests/support/estimator_states.hpp"

namespace lxd::test {

struct ScenePoint {
  Eigen::Vector3d p_m;  // at time zero
  Eigen::Vector3d v_mps = Eigen::Vector3d::Zero();
};

class FeatureScene {
 public:
  static constexpr double kPeriod_s = 0.1;
  double noise_px = 0.5;
  std::vector<ScenePoint> points;
  MountedCamera camera{CameraModel(radtan_camera()), forward()};

  explicit FeatureScene(bool with_map) {
    if (!with_map) return;
    cast.add_room({0, 0, 0}, {10, 8, 3});
    cast.fuse({5, 4, 1.5F}, 5);
  }

  // On the far wall and the floor before the camera.
  void add_on_surfaces(int count) {
    for (int i = 0; i < count; ++i)
      points.push_back(i % 3 == 0 ? ScenePoint{{chance.uniform(5.5, 9), chance.uniform(1.5, 6.5), 0}}
                                  : ScenePoint{{10, chance.uniform(1, 7), chance.uniform(0.3, 2.8)}});
  }
  // Higher than any wall.
  void add_in_the_air(int count) {
    for (int i = 0; i < count; ++i)
      points.push_back({{chance.uniform(8, 14), chance.uniform(0, 8), chance.uniform(3.4, 4.5)}});
  }
  // A crossing cart: on the way, rigid.
  void add_moving(int count, const Eigen::Vector3d& v_mps) {
    for (int i = 0; i < count; ++i)
      points.push_back({{chance.uniform(6.5, 7), chance.uniform(3, 4.5), chance.uniform(0.5, 1.8)}, v_mps});
  }

  // Forwards and sideways with some turning.
  static Pose pose(double t_s) {
    return {Exp(Eigen::Vector3d(0.03 * std::sin(2 * t_s), 0.04 * std::cos(t_s), 0.1 * std::sin(t_s))),
            Eigen::Vector3d(1 + 0.3 * t_s, 4 + 0.8 * std::sin(0.6 * t_s), 1.5 + 0.1 * std::sin(t_s))};
  }

  FeatureFrame frame(double t_s, std::uint32_t first_id = 1) {
    FeatureFrame out;
    out.stamp = RigTime::from_seconds(t_s);
    const Pose T_camera_world = (pose(t_s) * camera.T_body_camera).inverse();
    for (std::size_t i = 0; i < points.size() && out.count < kFeaturesMax; ++i) {
      Eigen::Vector2d pixel;
      if (!camera.model.project(T_camera_world * (points[i].p_m + t_s * points[i].v_mps), pixel)) continue;
      pixel += noise_px * Eigen::Vector2d(chance.normal(), chance.normal());
      Eigen::Vector3d b;
      if (!camera.model.contains(pixel, 5) || !camera.model.unproject(pixel, b)) continue;
      const auto at = [](double x) { return static_cast<float>(x); };
      out.storage[out.count++] = {first_id + static_cast<std::uint32_t>(i),
                                  0,
                                  {at(pixel.x()), at(pixel.y())},
                                  {at(b.x()), at(b.y()), at(b.z())}};
    }
    return out;
  }

  static Pose forward() {
    Pose T_body_camera;
    T_body_camera.R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T_body_camera.p = {0.1, 0.05, 0};
    return T_body_camera;
  }

  StateChance chance{3};
  CastScene cast;
};

}  // namespace lxd::test
