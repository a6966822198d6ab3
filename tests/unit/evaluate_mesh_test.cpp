// SPDX-License-Identifier: Apache-2.0
// The evaluation of meshes on shapes whose distances are known.
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "backend/mesh_export.hpp"
#include "backend/trajectory_writer.hpp"
#include "tests/support/synthetic_mesh.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/evaluate.hpp"
#include "tools/evaluate/mesh_errors.hpp"
#include "tools/evaluate/triangle_grid.hpp"

namespace lxd::evaluate_mesh_test {
namespace {

using test::SyntheticMesh;
using test::TemporaryFolder;

TriangleMesh to_triangles(const SyntheticMesh& synthetic) {
  TriangleMesh mesh;
  for (const MeshVertex& v : synthetic.vertices) mesh.vertices_m.push_back(v.position_m.cast<double>());
  mesh.faces.assign(synthetic.faces.begin(), synthetic.faces.end());
  return mesh;
}

TriangleMesh room(float spacing_m = 0.5F) {
  SyntheticMesh mesh;
  for (const auto& [corner, u, v] : {std::array<Eigen::Vector3f, 3>{Eigen::Vector3f(0, 0, 0), {6, 0, 0}, {0, 4, 0}},
                                     std::array<Eigen::Vector3f, 3>{Eigen::Vector3f(0, 0, 0), {0, 0, 3}, {6, 0, 0}},
                                     std::array<Eigen::Vector3f, 3>{Eigen::Vector3f(0, 0, 0), {0, 4, 0}, {0, 0, 3}}})
    mesh.add_patch(corner, u, v, spacing_m);
  return to_triangles(mesh);
}

TEST(TriangleGrid, DistancesAgreeWithTryingEveryTriangle) {
  const TriangleMesh mesh = room(1.0F);
  const TriangleGrid grid(mesh, 0.3);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> at(-1, 6);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p(at(random), at(random), at(random));
    double wanted = 2;
    for (const auto& f : mesh.faces)
      wanted = std::min(
          wanted,
          (closest_on_triangle(p, mesh.vertices_m[f[0]], mesh.vertices_m[f[1]], mesh.vertices_m[f[2]]) - p).norm());
    EXPECT_NEAR(grid.distance_m(p, 2), wanted, 1e-12);
  }
}

TEST(ClosestOnTriangle, KnownAnswersInEveryRegion) {
  const Eigen::Vector3d a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const auto closest = [&](double x, double y) { return closest_on_triangle({x, y, 1}, a, b, c); };
  EXPECT_TRUE(closest(1, 1).isApprox(Eigen::Vector3d(1, 1, 0)));
  EXPECT_TRUE(closest(-1, -1).isZero());
  EXPECT_TRUE(closest(6, -1).isApprox(b));
  EXPECT_TRUE(closest(-1, 6).isApprox(c));
  EXPECT_TRUE(closest(2, -3).isApprox(Eigen::Vector3d(2, 0, 0)));
  EXPECT_TRUE(closest(-3, 2).isApprox(Eigen::Vector3d(0, 2, 0)));
  EXPECT_TRUE(closest(4, 4).isApprox(Eigen::Vector3d(2, 2, 0)));
}

TEST(TriangleGrid, WallHidesWhatIsBehindIt) {
  const TriangleMesh mesh = room();
  const TriangleGrid grid(mesh);
  EXPECT_FALSE(grid.hidden({1, 1, 1}, {5, 3, 2}));
  EXPECT_TRUE(grid.hidden({1, 1, 1}, {1.3, -2, 1.1})) << "through the wall y = 0";
  EXPECT_TRUE(grid.hidden({1, 1, 1}, {2.2, 1.7, -1}));
  EXPECT_FALSE(grid.hidden({1, 1, 1}, {2.2, 0, 1.4})) << "a point on the wall is seen";
  EXPECT_FALSE(grid.hidden({9, 9, 9}, {20, 30, 40})) << "outside of the grid nothing hides";
}

TEST(SurfaceSamples, AreSpreadByArea) {
  const TriangleMesh mesh = room(1.0F);
  const auto samples = sample_surface(mesh, 10'000);
  EXPECT_NEAR(static_cast<double>(samples.size()), 10'000, 2);
  const auto floor = std::ranges::count_if(samples, [](const MeshSample& s) { return s.p.z() == 0; });
  EXPECT_NEAR(static_cast<double>(floor) / 10'000, 24.0 / (24 + 18 + 12), 0.005);
}

MeshErrorOptions few() {
  MeshErrorOptions options;
  options.samples = 5000;
  return options;
}

const std::vector<Pose> kPath{{Eigen::Matrix3d::Identity(), {2, 2, 1.5}}, {Eigen::Matrix3d::Identity(), {4, 2, 1.5}}};

TEST(MeshErrors, WorldItselfIsPerfect) {
  const MeshErrors e = mesh_errors(room(), room(1.0F), kPath, few());
  EXPECT_LT(e.accuracy_m.max, 1e-9);
  EXPECT_LT(e.completeness_m.max, 1e-9);
  EXPECT_EQ(e.world_samples_counted, e.world_samples);
  EXPECT_DOUBLE_EQ(e.scores.at(0).f_score, 1);
}

TEST(MeshErrors, ShiftIsFoundAsDistance) {
  TriangleMesh shifted = room();
  shifted.transform({Eigen::Matrix3d::Identity(), {0, 0, 0.03}});
  const MeshErrors e = mesh_errors(shifted, room(), kPath, few());
  // Only the floor (24 of 54 m^2) is off by 3 cm; the walls slide along themselves.
  EXPECT_NEAR(e.accuracy_m.max, 0.03, 1e-6);
  EXPECT_NEAR(e.accuracy_m.mean, 0.03 * 24 / 54, 2e-4);
  EXPECT_NEAR(e.accuracy_m.rmse, 0.03 * std::sqrt(24.0 / 54), 2e-4);
  EXPECT_NEAR(e.scores.at(0).precision, 30.0 / 54, 0.02);
  EXPECT_DOUBLE_EQ(e.scores.at(1).precision, 1);
}

TEST(MeshErrors, HalfOfTheWorldMissingShowsInRecallOnly) {
  SyntheticMesh half, whole;
  half.add_patch({0, 0, 0}, {5, 0, 0}, {0, 4, 0});
  whole.add_patch({0, 0, 0}, {10, 0, 0}, {0, 4, 0});
  const MeshErrors e = mesh_errors(to_triangles(half), to_triangles(whole), kPath, few());
  EXPECT_DOUBLE_EQ(e.scores.at(1).precision, 1);
  EXPECT_NEAR(e.scores.at(1).recall, 0.505, 0.01);
}

TEST(MeshErrors, WorldOutOfSightDoesNotCount) {
  SyntheticMesh seen, world;
  seen.add_patch({0, 0, 0}, {6, 0, 0}, {0, 4, 0});
  world.add_patch({0, 0, 0}, {6, 0, 0}, {0, 4, 0});
  world.add_patch({0, 0, -1}, {6, 0, 0}, {0, 4, 0});   // the cellar's ceiling, hidden by the floor
  world.add_patch({100, 0, 0}, {6, 0, 0}, {0, 4, 0});  // too far
  const MeshErrors e = mesh_errors(to_triangles(seen), to_triangles(world), kPath, few());
  EXPECT_NEAR(static_cast<double>(e.world_samples_counted) / static_cast<double>(e.world_samples), 1.0 / 3, 0.02);
  EXPECT_DOUBLE_EQ(e.scores.at(0).recall, 1);
}

// Given a LiDAR that sees 10 degrees down and up, on a rig that stands level and then on its side; then the floor
// counts only where the level one meets it from afar, or the tilted one sweeps it.
TEST(MeshErrors, WorldOutsideOfTheFieldOfViewDoesNotCount) {
  SyntheticMesh floor;
  floor.add_patch({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 0.5F);
  MeshErrorOptions options = few();
  LidarView narrow;
  narrow.elevation_rad = {-0.1745, 0.1745};
  options.lidars = {narrow};
  const Pose level{Eigen::Matrix3d::Identity(), {0, 0, 2}};
  const TriangleMesh world = to_triangles(floor);
  const auto counted = [&](const Pose& pose) {
    const MeshErrors e = mesh_errors({}, world, std::span(&pose, 1), options);
    return static_cast<double>(e.world_samples_counted) / static_cast<double>(e.world_samples);
  };
  // All but the disc of 2 m / tan(10 deg) = 11.34 m about the rig.
  const double disc_m = 2 / std::tan(0.1745);
  EXPECT_NEAR(counted(level), 1 - std::numbers::pi * disc_m * disc_m / 1600, 0.01);
  const Pose on_its_side{Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                         {0, 0, 2}};
  // A strip across, |y| <= tan(10 deg) * hypot(x, 2): two hyperbolas.
  EXPECT_NEAR(counted(on_its_side), 2 * std::tan(0.1745) * 20 * 20 / 1600, 0.02);
}

TEST(MeshErrors, GlassHidesAndDoesNotCount) {
  SyntheticMesh synthetic;
  synthetic.add_patch({0, 0, 0}, {6, 0, 0}, {0, 4, 0});
  synthetic.add_patch({0, 0, 1}, {6, 0, 0}, {0, 4, 0});  // a pane between it and the path, as large
  TriangleMesh world = to_triangles(synthetic);
  const std::vector<Pose> above{{Eigen::Matrix3d::Identity(), {3, 2, 1.5}}};
  const std::size_t opaque = mesh_errors({}, world, above, few()).world_samples_counted;
  EXPECT_GT(opaque, 2450U) << "all of the pane";
  world.glass.assign(world.faces.size() / 2, 0);
  world.glass.resize(world.faces.size(), 1);
  EXPECT_EQ(mesh_errors({}, world, above, few()).world_samples_counted, 0U);
}

TEST(MeshErrors, EmptyMeshCoversNothing) {
  const MeshErrors e = mesh_errors({}, room(), kPath, few());
  EXPECT_EQ(e.accuracy_m.count, 0U);
  EXPECT_DOUBLE_EQ(e.scores.at(2).f_score, 0);
  EXPECT_DOUBLE_EQ(e.completeness_m.max, few().reach_m);
}

// Given a mesh that a run made in its own map frame, its path aligns it with the world before it is measured.
TEST(MeshEvaluation, AlignsTheMeshByThePath) {
  const TemporaryFolder folder;
  SyntheticMesh mesh;
  mesh.add_room({0, 0, 0}, {6, 4, 3});
  const Pose T_map_world{Eigen::AngleAxisd(0.8, Eigen::Vector3d(0.1, 0, 1).normalized()).toRotationMatrix(),
                         {30, -20, 5}};
  const auto write = [&](const std::string& name, const Pose& T) {
    auto writer = ArchiveWriter::create(folder / "map.db");
    EXPECT_TRUE(writer->append(mesh.view(0, T)).ok());
    EXPECT_TRUE(writer->finish().ok());
    EXPECT_TRUE(write_mesh_ply(folder / (name + ".ply"), *Archive::open(folder / "map.db")).ok());
    std::vector<StampedPose> path;
    for (int i = 0; i < 100; ++i)
      path.push_back({RigTime::from_ns(i * 100'000'000LL),
                      T * Pose{Eigen::Matrix3d::Identity(), {3 + 2 * std::cos(0.1 * i), 2 + std::sin(0.1 * i), 1.5}}});
    EXPECT_TRUE(write_trajectory(folder / (name + ".tum"), path).ok());
  };
  write("estimate", T_map_world);
  write("truth", {});
  EvaluateOptions options;
  options.estimate = folder / "estimate.tum";
  options.truth = folder / "truth.tum";
  options.mesh = folder / "estimate.ply";
  options.world = folder / "truth.ply";
  options.mesh_errors.samples = 5000;
  const auto report = evaluate(options);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_LT(report->mesh->accuracy_m.max, 1e-5) << "positions are floats";
  EXPECT_LT(report->mesh->completeness_m.max, 1e-5);
  EXPECT_NE(to_table(*report).find("F-score"), std::string::npos);
  EXPECT_DOUBLE_EQ(to_json(*report)["mesh"]["scores"][0]["f_score"].get<double>(), 1);
  EXPECT_EQ(to_json(*report)["mesh"]["calibration"]["deciles"].size(), 10U) << "our meshes know their variance";

  // And with the rig, whose LiDAR looks over the floor and below the ceiling: less counts, and all of that is there.
  test::write_file(folder / "rig.yaml",
                   "reference: lidar0\nlidar0: {model: spinning, beams: 16, columns: 1024, fov_deg: [-10, 10]}\n");
  options.rig = folder / "rig.yaml";
  const auto narrow = evaluate(options);
  ASSERT_TRUE(narrow.ok()) << narrow.error().message;
  EXPECT_LT(narrow->mesh->world_samples_counted, report->mesh->world_samples_counted / 2);
  EXPECT_GT(narrow->mesh->world_samples_counted, 0U);
  EXPECT_DOUBLE_EQ(narrow->mesh->scores.at(0).recall, 1);
  options.rig = folder / "no.yaml";
  EXPECT_FALSE(evaluate(options).ok());
}

}  // namespace
}  // namespace lxd::evaluate_mesh_test
