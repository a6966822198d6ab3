// SPDX-License-Identifier: Apache-2.0
// What beams that go through known surfaces say of where a body is.
#include <gtest/gtest.h>

#include "estimator/pierced_surfaces.hpp"
#include "tests/support/cast_scene.hpp"

namespace lxd::estimator_pierced_surfaces_test {
namespace {

using Eigen::Vector3d;
using test::CastScene;

constexpr std::size_t kBeams = 300;
constexpr double kBay_m = 2.5, kCarHeight_m = 1.5;

// A floor of 12 m x 8 m and a wall behind it; before the wall a row of bays, of which some have a car: its near side.
class CarPark : public testing::Test {
 protected:
  CarPark() {
    scene.add_patch({0, 0, 0}, {12, 0, 0}, {0, 8, 0});
    scene.add_patch({0, 8, 0}, {12, 0, 0}, {0, 0, 3});
    for (const int bay : {0, 1, 3})
      scene.add_patch(Vector3d(bay * kBay_m, 4, 0).cast<float>(), {2, 0, 0}, {0, 0, kCarHeight_m});
    scene.fuse({5, 1, 1});
  }
  // What a LiDAR sees from there: from cars and, where there are none, from the wall.
  static std::vector<RegistrationPoint> seen_from(const Vector3d& lidar_m) {
    std::vector<RegistrationPoint> points;
    for (double x_m = 0.05; x_m < 11; x_m += 0.1)
      for (double z_m = 0.1; z_m < 1.2; z_m += 0.3)
        points.push_back({end_of({x_m, 8, z_m}, lidar_m) - lidar_m, 0, 1e-4F});
    return points;
  }
  [[nodiscard]] double pierced(const std::vector<RegistrationPoint>& points, const Vector3d& lidar_m) const {
    State x;
    x.p = lidar_m;
    SweepPath path;
    path.set(x, Duration());
    return pierced_share(points, path, Vector3d::Zero(), scene.map, kBeams);
  }
  CastScene scene;

 private:
  // Of the beam that would end on the wall there.
  static Vector3d end_of(const Vector3d& on_wall_m, const Vector3d& lidar_m) {
    const double share = (4 - lidar_m.y()) / (8 - lidar_m.y());
    const Vector3d at_cars = lidar_m + share * (on_wall_m - lidar_m);
    for (const int bay : {0, 1, 3})
      if (at_cars.x() > bay * kBay_m && at_cars.x() < bay * kBay_m + 2) return at_cars;
    return on_wall_m;
  }
};

// Given a sweep of a car park, when the body is where it is, then next to no beam goes through what is known.
TEST_F(CarPark, WhereTheBodyIsSurfacesAreOpaque) {
  const Vector3d lidar_m(5, 1, 1);
  EXPECT_LT(pierced(seen_from(lidar_m), lidar_m), 0.02);
  EXPECT_LT(pierced(seen_from(lidar_m), lidar_m + Vector3d(0.1, -0.1, 0)), 0.02);
}

// When it is taken to be one bay farther, where floor and wall are the same, then beams go through cars.
TEST_F(CarPark, OneBayOffBeamsGoThroughCars) {
  const Vector3d lidar_m(5, 1, 1);
  EXPECT_GT(pierced(seen_from(lidar_m), lidar_m + Vector3d(kBay_m, 0, 0)), 0.1);
  EXPECT_GT(pierced(seen_from(lidar_m), lidar_m - Vector3d(kBay_m, 0, 0)), 0.1);
}

// Given what nobody knew before, or nothing at all; then it is no contradiction.
TEST_F(CarPark, WhatIsNewIsNoContradiction) {
  const Vector3d lidar_m(5, 1, 1);
  std::vector<RegistrationPoint> new_car;
  for (double z_m = 0.1; z_m < 1.4; z_m += 0.1) new_car.push_back({Vector3d(5.5, 3.5, z_m) - lidar_m, 0, 1e-4F});
  EXPECT_EQ(pierced(new_car, lidar_m), 0);
  EXPECT_EQ(pierced({}, lidar_m), 0);
}

}  // namespace
}  // namespace lxd::estimator_pierced_surfaces_test
