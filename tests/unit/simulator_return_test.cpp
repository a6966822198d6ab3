// SPDX-License-Identifier: Apache-2.0
// What a LiDAR makes of a surface: noise, weak signals, glass, edges, dust; each as large as configured, and off.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/lidar_rig.hpp"
#include "tools/simulator/lidar/return_model.hpp"

namespace lxd::test::simulator_return_test {
namespace {

using namespace sim;

constexpr int kShots = 20000;

// A shot along x at a surface met at an angle.
Shot shot_at(float range_m, float albedo, double incidence_rad = 0, std::uint16_t material = 0) {
  Shot shot;
  shot.ray = {Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX(), 0, 300};
  shot.hit.range_m = range_m;
  shot.hit.normal = {static_cast<float>(-std::cos(incidence_rad)), static_cast<float>(std::sin(incidence_rad)), 0};
  shot.hit.albedo = albedo;
  shot.hit.material = material;
  return shot;
}

struct Statistics {
  double part = 0, mean_m = 0, sigma_m = 0;
};

Statistics of_many(const ReturnConfig& config, const Shot& shot, const Shot* neighbour = nullptr) {
  const World world = hall();
  const ReturnModel model(config, world);
  Random random(1, "returns");
  double sum = 0, squares = 0;
  int found = 0;
  for (int i = 0; i < kShots; ++i) {
    const Return measured = model.measure(shot, neighbour, ShotFault::kNone, random);
    if (!measured.found()) continue;
    ++found;
    sum += measured.range_m;
    squares += measured.range_m * measured.range_m;
  }
  const double mean = sum / found;
  return {static_cast<double>(found) / kShots, mean, std::sqrt(std::max(0.0, squares / found - mean * mean))};
}

ReturnConfig plain() { return without_errors(ReturnConfig{}); }

TEST(LidarReturn, WithoutErrorsIsExactAndAlwaysThere) {
  const Statistics s = of_many(plain(), shot_at(100, 0.01F, 1.5));
  EXPECT_EQ(s.part, 1);
  EXPECT_EQ(s.mean_m, 100);
  EXPECT_EQ(s.sigma_m, 0);
}

TEST(LidarReturn, NoiseIsAsConfiguredHeadOnAndGrowsWithIncidence) {
  ReturnConfig config = plain();
  config.range_sigma_m = 0.02;
  EXPECT_NEAR(of_many(config, shot_at(10, 0.5F)).sigma_m, 0.02, 0.0005);
  EXPECT_NEAR(of_many(config, shot_at(10, 0.5F)).mean_m, 10, 0.0005);
  EXPECT_NEAR(of_many(config, shot_at(10, 0.5F, std::acos(0.5))).sigma_m, 0.04, 0.001);
}

TEST(LidarReturn, NineOfTenReturnFromADarkSurfaceAtTheDetectionRange) {
  ReturnConfig config = plain();
  config.detection_range_m = 50;
  EXPECT_NEAR(of_many(config, shot_at(50, 0.1F)).part, 0.9, 0.01);
  EXPECT_GT(of_many(config, shot_at(25, 0.1F)).part, 0.999);     // nearer
  EXPECT_GT(of_many(config, shot_at(100, 0.8F)).part, 0.99);     // brighter
  EXPECT_LT(of_many(config, shot_at(100, 0.1F)).part, 0.05);     // farther
  EXPECT_LT(of_many(config, shot_at(50, 0.1F, 1.2)).part, 0.2);  // grazed
}

TEST(LidarReturn, NothingComesBackThroughGlassOrFromOutOfRange) {
  EXPECT_EQ(of_many(plain(), shot_at(5, 0.5F, 0, 1)).part, 0);
  ReturnConfig frosted = plain();
  frosted.glass_part = 0.3;
  EXPECT_NEAR(of_many(frosted, shot_at(5, 0.5F, 0, 1)).part, 0.7, 0.02);
  EXPECT_EQ(of_many(plain(), shot_at(0.4F, 0.5F)).part, 0);
  EXPECT_EQ(of_many(plain(), shot_at(151, 0.5F)).part, 0);
}

TEST(LidarReturn, BesideAnEdgeARangeBetweenTheSurfaces) {
  ReturnConfig config = plain();
  config.mixed_part = 0.5;
  Shot beside = shot_at(10.6F, 0.5F);
  beside.ray.direction = Eigen::Vector3f(1, 0.006F, 0).normalized();
  const Shot shot = shot_at(10, 0.5F);
  EXPECT_NEAR(of_many(config, shot, &beside).mean_m, 10 + 0.5 * 0.3, 0.01);
  beside.hit.range_m = 10.01F;  // a wall, no edge
  EXPECT_EQ(of_many(config, shot, &beside).sigma_m, 0);
  beside.hit.range_m = 13;  // two echoes apart
  EXPECT_EQ(of_many(config, shot, &beside).sigma_m, 0);
  const Shot slanted = shot_at(10, 0.5F, 1.3);
  Shot on_it = slanted;  // the next shot at the same slanted board: further away, and yet no edge
  on_it.ray.direction = Eigen::Vector3f(1, 0.03F, 0).normalized();
  on_it.hit.range_m =
      static_cast<float>(10 * std::cos(1.3) / (std::cos(1.3) - 0.03 * std::sin(1.3)) * std::hypot(1, 0.03));
  EXPECT_GT(on_it.hit.range_m, 11);
  EXPECT_EQ(of_many(config, slanted, &on_it).sigma_m, 0);
}

TEST(LidarReturn, OutliersAreAsManyAsConfigured) {
  ReturnConfig config = plain();
  config.outlier_part = 0.1;
  Shot sky = shot_at(Hit::kNone, 0);
  EXPECT_NEAR(of_many(config, sky).part, 0.1, 0.01);
  EXPECT_EQ(of_many(plain(), sky).part, 0);
}

}  // namespace
}  // namespace lxd::test::simulator_return_test
