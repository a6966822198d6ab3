// SPDX-License-Identifier: Apache-2.0
// What a LiDAR can see: within its field, its range, not at a grazing angle, and not through walls.
#include <gtest/gtest.h>

#include "tests/support/synthetic_mesh.hpp"
#include "tools/evaluate/world_sight.hpp"

namespace lxd::evaluate_world_sight_test {
namespace {

using Eigen::Vector3d;

constexpr double kRadians = std::numbers::pi / 180;

// A wall x = 10 m, seen from the origin; behind it another.
class Walls : public ::testing::Test {
 protected:
  Walls() {
    test::SyntheticMesh synthetic;
    synthetic.add_patch({10, -8, -8}, {0, 16, 0}, {0, 0, 16}, 2);
    synthetic.add_patch({12, -8, -8}, {0, 16, 0}, {0, 0, 16}, 2);
    for (const MeshVertex& v : synthetic.vertices) world_.vertices_m.push_back(v.position_m.cast<double>());
    world_.faces.assign(synthetic.faces.begin(), synthetic.faces.end());
    lidar_.elevation_rad = {-20 * kRadians, 10 * kRadians};
    lidar_.range_m = {0.5, 30};
    lidar_.incidence_max_rad = 85 * kRadians;
  }
  bool sees(const Vector3d& p, const Vector3d& normal = -Vector3d::UnitX(), const Pose& rig = {}) const {
    const TriangleGrid grid(world_);
    return WorldSight(grid, std::span(&rig, 1), std::span(&lidar_, 1), 1, 1).sees(p, normal);
  }
  TriangleMesh world_;
  LidarView lidar_;
};

Vector3d on_the_wall(double elevation_deg) { return {10, 0, 10 * std::tan(elevation_deg * kRadians)}; }

TEST_F(Walls, ItsFieldOfViewEndsWhereTheRigFileSays) {
  EXPECT_TRUE(sees(on_the_wall(9.9)));
  EXPECT_FALSE(sees(on_the_wall(10.1)));
  EXPECT_TRUE(sees(on_the_wall(-19.9)));
  EXPECT_FALSE(sees(on_the_wall(-20.1)));
}

TEST_F(Walls, TheFieldTurnsWithRigAndSensor) {
  const Pose nose_up{Eigen::AngleAxisd(-15 * kRadians, Vector3d::UnitY()).toRotationMatrix(), Vector3d::Zero()};
  EXPECT_TRUE(sees(on_the_wall(24.9), -Vector3d::UnitX(), nose_up));
  EXPECT_FALSE(sees(on_the_wall(25.1), -Vector3d::UnitX(), nose_up));
  lidar_.T_reference_lidar = nose_up.inverse();
  EXPECT_TRUE(sees(on_the_wall(9.9), -Vector3d::UnitX(), nose_up)) << "the sensor is mounted to undo it";
  EXPECT_FALSE(sees(on_the_wall(10.1), -Vector3d::UnitX(), nose_up));
}

TEST_F(Walls, TheRangeEndsAtBothEnds) {
  lidar_.range_m = {0.5, 9.9};
  EXPECT_FALSE(sees({10, 0, 0}));
  lidar_.range_m = {10.1, 30};
  EXPECT_FALSE(sees({10, 0, 0}));
  lidar_.range_m = {9.9, 10.1};
  EXPECT_TRUE(sees({10, 0, 0}));
}

TEST_F(Walls, TheRangeIsCountedFromTheSensor) {
  lidar_.range_m = {0.5, 9};
  EXPECT_FALSE(sees({10, 0, 0}));
  lidar_.T_reference_lidar.p = {2, 0, 0};
  EXPECT_TRUE(sees({10, 0, 0}));
}

TEST_F(Walls, GrazedSurfacesDoNotCount) {
  const auto tilted = [](double deg) { return Vector3d(std::cos(deg * kRadians), std::sin(deg * kRadians), 0); };
  EXPECT_TRUE(sees({10, 0, 0}, tilted(84)));
  EXPECT_TRUE(sees({10, 0, 0}, -tilted(84))) << "of either side";
  EXPECT_FALSE(sees({10, 0, 0}, tilted(86)));
}

TEST_F(Walls, WhatIsBehindAWallIsHidden) { EXPECT_FALSE(sees({12, 0, 0})); }

TEST_F(Walls, AnyPlaceOnTheWayAndAnyLidarWillDo) {
  const TriangleGrid grid(world_);
  const std::vector<Pose> path{{}, {Eigen::Matrix3d::Identity(), {11, 0, 0}}};
  EXPECT_TRUE(WorldSight(grid, path, std::span(&lidar_, 1), 1, 1).sees({12, 0, 0}, Vector3d::UnitX()));
  LidarView second = lidar_;
  second.T_reference_lidar.p = {11, 0, 0};
  const std::array lidars{lidar_, second};
  EXPECT_TRUE(WorldSight(grid, std::span(path).first(1), lidars, 1, 1).sees({12, 0, 0}, Vector3d::UnitX()));
}

TEST_F(Walls, ViewpointsAreTakenWhereTheRigHasGoneOrTurned) {
  const TriangleGrid grid(world_);
  std::vector<Pose> path;
  for (int i = 0; i < 101; ++i)  // 5 m along, then half a turn on the spot
    path.push_back({Eigen::AngleAxisd(std::max(0, i - 50) * 3.6 * kRadians, Vector3d::UnitZ()).toRotationMatrix(),
                    {std::min(i, 50) * 0.1, 0, 0}});
  EXPECT_EQ(WorldSight(grid, path, std::span(&lidar_, 1), 0.999, 17.99 * kRadians).viewpoints(), 16U);
}

TEST(LidarViews, AreThoseOfTheRigFile) {
  Rig rig;
  rig.lidar0.fov_deg = {-22.5, 22.5};
  rig.lidar0.range_m = {0.3, 120};
  rig.lidar0.T_reference_sensor.p = {0, 0, 1};
  rig.lidar1.emplace();
  const auto views = lidar_views(rig, 30);
  ASSERT_EQ(views.size(), 2U);
  EXPECT_NEAR(views[0].elevation_rad[1], 22.5 * kRadians, 1e-12);
  EXPECT_EQ(views[0].range_m, (std::array<double, 2>{0.3, 30})) << "not beyond what was asked for";
  EXPECT_EQ(views[0].T_reference_lidar.p.z(), 1);
  EXPECT_NEAR(views[1].elevation_rad[1], std::numbers::pi / 2, 1e-12) << "not told: everywhere";
}

}  // namespace
}  // namespace lxd::evaluate_world_sight_test
