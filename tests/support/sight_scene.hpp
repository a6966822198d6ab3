// SPDX-License-Identifier: Apache-2.0
// Two looks at one cloud of points from different places, with the features that the two cameras would keep: noise,
// distances that only some have, wrong matches.
#pragma once

#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "backend/pnp/visual_key_frame.hpp"
#include "rt/so3.hpp"

namespace lxd::test {

struct SightConfig {
  double turn_rad = 0.5;        // about the middle of the cloud, between the two looks
  double half_view_rad = 0.65;  // of either camera
  int points = 150;
  double bearing_sigma_rad = 0.002;
  double distance_sigma = 0.03;    // share of the distance
  double historical_points = 0.9;  // share of features with a distance
  double current_points = 0.9;
  double wrong = 0.2;  // share of current features that carry another's descriptor
};

class SightScene {
 public:
  SightScene(const SightConfig& config, unsigned seed) : config_(config), engine_(seed) {
    constexpr double kMiddle_m = 10;
    const Pose middle{Eigen::Matrix3d::Identity(), {0, 0, kMiddle_m}};
    T_HC = middle * Pose{Exp({0.1 * normal(), config.turn_rad, 0.1 * normal()}), Eigen::Vector3d::Zero()} *
           Pose{Eigen::Matrix3d::Identity(), {0.3 * normal(), 0.3 * normal(), -kMiddle_m + normal()}};
    historical.id = 3;
    current.id = 9;
    // Camera z along the body's x, a lever beside it.
    historical.T_body_camera.R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    historical.T_body_camera.p = {0.2, -0.1, 0.3};
    current.T_body_camera = historical.T_body_camera;
    for (int i = 0; i < config.points; ++i) add_point();
  }

  // What a loop should say.
  [[nodiscard]] Pose T_from_to() const { return historical.T_body_camera * T_HC * current.T_body_camera.inverse(); }

  VisualKeyFrame historical, current;
  Pose T_HC;

 private:
  double normal() { return std::normal_distribution<double>()(engine_); }
  double uniform() { return std::uniform_real_distribution<double>()(engine_); }
  OrbDescriptor any_descriptor() {
    OrbDescriptor out;
    for (auto& byte : out) byte = static_cast<std::uint8_t>(engine_());
    return out;
  }
  OrbDescriptor seen_again(OrbDescriptor d) {
    constexpr int kFlipped = 20;
    for (int i = 0; i < kFlipped; ++i) d[engine_() % d.size()] ^= static_cast<std::uint8_t>(1U << (engine_() % 8));
    return d;
  }

  void add_point() {
    const Eigen::Vector3d p(4 * (2 * uniform() - 1), 2.5 * (2 * uniform() - 1), 10 + 3 * (2 * uniform() - 1));
    const OrbDescriptor descriptor = any_descriptor();
    see(historical, p, descriptor, config_.historical_points);
    const bool wrong = uniform() < config_.wrong;
    see(current, T_HC.inverse() * p,
        wrong && !historical.features.empty() ? any_of_historical() : seen_again(descriptor), config_.current_points);
  }
  OrbDescriptor any_of_historical() {
    return seen_again(historical.features[engine_() % historical.features.size()].descriptor);
  }

  void see(VisualKeyFrame& frame, const Eigen::Vector3d& p, const OrbDescriptor& descriptor, double with_point) {
    if (std::atan2(p.head<2>().norm(), p.z()) > config_.half_view_rad) return;
    VisualFeature feature;
    feature.descriptor = descriptor;
    const Eigen::Vector3d noise = config_.bearing_sigma_rad * Eigen::Vector3d(normal(), normal(), normal());
    feature.bearing = (p.normalized() + noise).normalized().cast<float>();
    feature.sigma_rad = static_cast<float>(config_.bearing_sigma_rad);
    if (uniform() < with_point) {
      feature.distance_m = static_cast<float>(p.norm() * (1 + config_.distance_sigma * normal()));
      feature.distance_sigma_m = static_cast<float>(config_.distance_sigma * p.norm());
    }
    frame.features.push_back(feature);
  }

  SightConfig config_;
  std::mt19937 engine_;
};

}  // namespace lxd::test
