// SPDX-License-Identifier: Apache-2.0
// Point-to-mesh residuals: the row against numeric differentiation (and not the paper's printed one), the variance, and
// which points find a surface.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/point_to_mesh.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/mapping_scene.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_point_to_mesh_test {
namespace {

using Eigen::Vector3d;
using test::check_property;
using test::StateChance;

constexpr double kTau_s = 0.07;

StateChance any_chance() { return StateChance(*rc::gen::arbitrary<unsigned>()); }

// A plane n^T p + d of the world and a return near it.
struct PlaneCase {
  explicit PlaneCase(StateChance& chance)
      : end(chance.state()), n(chance.direction().cast<float>()), point{chance.vector(10), 0, 4e-4F} {
    n.normalize();
  }
  [[nodiscard]] double distance(const State& x) const {
    const PathKnot k = SweepPath::knot(x, kTau_s);
    return n.cast<double>().dot(k.R * point.p_body_m + k.p - end.p);
  }
  [[nodiscard]] PointResidual residual() const {
    return point_to_surface(point, SweepPath::knot(end, kTau_s), {static_cast<float>(distance(end)), 1e-4F, n});
  }

  State end;
  Eigen::Vector3f n;
  RegistrationPoint point;
};

TEST(EstimatorPointToMesh, TheRowAgreesWithNumericDifferentiation) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const PlaneCase plane(chance);
        const auto numeric = test::numeric_jacobian<1>(
            plane.end, [&](const State& x) { return Eigen::Matrix<double, 1, 1>(plane.distance(x)); });
        RC_ASSERT((numeric.head<kLidarDim>().transpose() - plane.residual().row).cwiseAbs().maxCoeff() < 1e-6);
        RC_ASSERT(numeric.tail<kStateDim - kLidarDim>().cwiseAbs().maxCoeff() < 1e-9);
      },
      500);
}

// n^T (R p)^ is the derivative by a perturbation on the left, of the other sign: a filter with it would walk away.
TEST(EstimatorPointToMesh, ThePrintedJacobianIsNotTheOneOfTheRightPerturbation) {
  StateChance chance(21);
  const PlaneCase plane(chance);
  const PathKnot knot = SweepPath::knot(plane.end, 0);
  const Vector3d n = plane.n.cast<double>();
  const Vector3d printed = (n.transpose() * hat(knot.R * plane.point.p_body_m)).transpose();
  const PointResidual ours = point_to_surface(plane.point, knot, {0, 1e-4F, plane.n});
  const Vector3d row = ours.row.segment<3>(kTheta);
  EXPECT_GT((row - printed).norm(), 0.1 * printed.norm());
  EXPECT_LT((row + plane.end.R.transpose() * printed).norm(), 1e-12);
}

TEST(EstimatorPointToMesh, ThePointAtTheSweepsEndSaysNothingOfTheRates) {
  StateChance chance(22);
  const PlaneCase plane(chance);
  const PointResidual out = point_to_surface(plane.point, SweepPath::knot(plane.end, 0), {0, 1e-4F, plane.n});
  EXPECT_EQ((out.row.tail<6>().norm()), 0);
}

TEST(EstimatorPointToMesh, TheVarianceIsTheSurfacesPlusTheSensors) {
  StateChance chance(23);
  const PointResidual out = PlaneCase(chance).residual();
  EXPECT_NEAR(out.variance_m2, 1e-4 + 4e-4, 1e-10);
}

TEST(EstimatorPointToMesh, TheResidualIsTheSurfacesSignedDistance) {
  StateChance chance(24);
  const PlaneCase plane(chance);
  const PathKnot knot = SweepPath::knot(plane.end, 0);
  EXPECT_EQ(point_to_surface(plane.point, knot, {-0.25F, 1e-4F, plane.n}).r_m, -0.25);
}

// A floor of 4 m x 4 m at z = 0.2, known to a map.
class FloorMap {
 public:
  static inline const Vector3d kLidar_m{2, 2, 2};

  FloorMap() : arena_(std::size_t{8} << 20), map({}, {kCapacity, kCapacity}, *arena_) {
    std::vector<MapPoint> points;
    for (int i = 0; i < 80; ++i)
      for (int k = 0; k < 80; ++k)
        points.push_back({{0.05F * static_cast<float>(i), 0.05F * static_cast<float>(k), 0.2F}, 1e-4F});
    map.insert({points, {}, Vector3d::Zero(), kLidar_m.cast<float>(), RigTime::from_ns(0)});
  }

 private:
  static constexpr SubMeshCapacity kCapacity{500, 500, 500, 8000};
  test::OwnedArena arena_;

 public:
  SurfaceMap map;
};

TEST(EstimatorPointToMesh, AssociationFindsTheFloorAndLeavesOutWhatHasNoSurface) {
  FloorMap floor;
  // Given a return 3 cm above the floor, one far off everything, one that is no number, and one 2 cm below ...
  const float nan = std::nanf("");
  const std::vector<RegistrationPoint> points = {{{1.1, 1.2, 0.23}, 0, 4e-4F},
                                                 {{50, 50, 50}, 0, 4e-4F},
                                                 {{nan, 1.0, 0.2}, 0, 4e-4F},
                                                 {{2.6, 2.7, 0.18}, 0, 4e-4F}};
  std::vector<PointResidual> storage(points.size());
  SweepPath path;
  path.set(State{}, Duration());
  const auto residuals = associate(points, path, FloorMap::kLidar_m, floor.map, storage);
  // ... then the two near it are measured, in their order.
  ASSERT_EQ(residuals.size(), 2U);
  EXPECT_NEAR(residuals[0].r_m, 0.03, 2e-3);
  EXPECT_NEAR(residuals[1].r_m, -0.02, 2e-3);
  EXPECT_LT((residuals[0].row.segment<3>(kPosition) - Vector3d::UnitZ()).norm(), 1e-2);
  EXPECT_GT(residuals[0].variance_m2, 4e-4);
}

// Given a ceiling's returns 20 cm below the floor of the storey above, from a LiDAR in the storey below, then it is not
// that floor which they are measured against; nearly along the floor nobody can tell.
TEST(EstimatorPointToMesh, TheBackOfASurfaceIsAnother) {
  FloorMap floor;
  const std::vector<RegistrationPoint> points = {{{2.1, 2.2, 0.0}, 0, 4e-4F}};
  std::vector<PointResidual> storage(points.size());
  SweepPath path;
  path.set(State{}, Duration());
  EXPECT_TRUE(associate(points, path, {2, 2, -2}, floor.map, storage).empty());
  EXPECT_EQ(associate(points, path, {-8, 2, -1}, floor.map, storage).size(), 1U);
  EXPECT_EQ(associate(points, path, FloorMap::kLidar_m, floor.map, storage).size(), 1U);
}

TEST(EstimatorPointToMesh, AnEmptyMapGivesNoResidual) {
  test::OwnedArena arena(std::size_t{1} << 20);
  const SubMeshCapacity capacity{10, 10, 10, 10};
  const SurfaceMap map({}, {capacity, capacity}, *arena);
  const std::vector<RegistrationPoint> points = {{{1, 2, 3}, 0, 4e-4F}};
  std::vector<PointResidual> storage(1);
  EXPECT_TRUE(associate(points, SweepPath(), Vector3d::Zero(), map, storage).empty());
}

}  // namespace
}  // namespace lxd::estimator_point_to_mesh_test
