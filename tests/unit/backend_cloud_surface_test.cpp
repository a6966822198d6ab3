// SPDX-License-Identifier: Apache-2.0
// What a cloud's points have of the surfaces that they lie on: normal, variance, colour.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "backend/cloud_surface.hpp"
#include "rt/so3.hpp"
#include "tests/support/synthetic_mesh.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::backend_cloud_surface_test {
namespace {

using test::SyntheticMesh;
using test::TemporaryFolder;

constexpr double kRadius_m = 0.1;
const RigTime kBegin = RigTime::from_ns(2'000'000'000);

std::vector<CloudPoint> points_of(const std::filesystem::path& path) {
  auto reader = CloudReader::open(path);
  EXPECT_TRUE(reader.ok()) << reader.error().message;
  std::vector<CloudPoint> points;
  const Status read = reader->for_each_chunk([&](std::span<const CloudPoint> chunk) {
    points.insert(points.end(), chunk.begin(), chunk.end());
    return success();
  });
  EXPECT_TRUE(read.ok()) << read.error().message;
  return points;
}

Eigen::Vector3f normal_of(const CloudPoint& point) { return {point.surface.nx, point.surface.ny, point.surface.nz}; }

class SurfaceCloud : public ::testing::Test {
 protected:
  void keep(const SyntheticMesh& mesh, const std::vector<VertexColour>& colours = {}) {
    auto archive = ArchiveWriter::create(folder_ / "map.db");
    ASSERT_TRUE(archive->append(mesh.view(0)).ok());
    const Status told = colours.empty() ? success() : archive->set_colours(0, colours);
    ASSERT_TRUE(told.ok());
    ASSERT_TRUE(archive->finish().ok());
  }

  void keep(const std::vector<CloudPoint>& points) {
    auto writer = CloudWriter::create(cloud_);
    ASSERT_TRUE(writer->append(points).ok());
    ASSERT_TRUE(writer->close().ok());
  }

  std::vector<CloudPoint> told(const Pose& T_cloud_submesh, std::vector<StampedPose> path = {}, bool coloured = false) {
    const auto archive = Archive::open(folder_ / "map.db");
    const std::vector<PlacedSubmesh> placed{{kBegin, 0, T_cloud_submesh}};
    const Status done = add_surfaces(
        cloud_, *archive,
        {.submeshes = placed, .path = path, .sensors = sensors_, .radius_m = kRadius_m, .coloured = coloured});
    EXPECT_TRUE(done.ok()) << done.error().message;
    return points_of(cloud_);
  }

  TemporaryFolder folder_;
  std::filesystem::path cloud_ = folder_ / "cloud.ply";
  std::vector<Eigen::Vector3d> sensors_{Eigen::Vector3d::Zero()};  // in the body
};

// Given a floor whose variance grows along x, in a sub-mesh that stands on its side 10 m along x of the cloud's frame.
TEST_F(SurfaceCloud, HasNormalAndVarianceOfTheNearestVertex) {
  SyntheticMesh mesh;
  mesh.add_patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1F);
  for (MeshVertex& v : mesh.vertices) v.variance_m2 = 1e-4F * (1 + v.position_m.x());
  keep(mesh);
  const Pose T_cloud_submesh{Exp(Eigen::Vector3d(std::numbers::pi / 2, 0, 0)), {10, 0, 0}};  // z becomes -y
  keep(std::vector<CloudPoint>{{10.22F, 0.01F, 0.33F, 7, 2.5}, {10.78F, -0.02F, 0.61F, 8, 2.6}});

  const auto points = told(T_cloud_submesh);
  ASSERT_EQ(points.size(), 2U);
  for (const CloudPoint& point : points) EXPECT_LT((normal_of(point) - Eigen::Vector3f(0, -1, 0)).norm(), 1e-6F);
  EXPECT_NEAR(points[0].surface.variance_m2, 1.2e-4F, 1e-9F);
  EXPECT_NEAR(points[1].surface.variance_m2, 1.8e-4F, 1e-9F);
  EXPECT_EQ(points[0].x_m, 10.22F) << "the point stays where it was measured";
  EXPECT_EQ(points[0].y_m, 0.01F);
  EXPECT_EQ(points[1].intensity, 8);
}

// Off the surface, of a time before it, beyond its rim, and so far off that it has no cell.
TEST_F(SurfaceCloud, SaysWherePointsLieOnNone) {
  SyntheticMesh mesh;
  mesh.add_patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1F);
  keep(mesh);
  keep(std::vector<CloudPoint>{{0.2F, 0.3F, 0, 1, 0.5},
                               {0.2F, 0.3F, 0.2F, 1, 2.5},
                               {1.2F, 0.3F, 0, 1, 2.6},
                               {3e30F, 0, 0, 1, 2.7},
                               {0.2F, 0.3F, 0, 1, 2.8}});
  const auto points = told({});
  ASSERT_EQ(points.size(), 5U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(normal_of(points[i]), Eigen::Vector3f::Zero().eval()) << i;
    EXPECT_TRUE(std::isnan(points[i].surface.variance_m2)) << i;
    EXPECT_FALSE(points[i].surface.known());
  }
  EXPECT_TRUE(points[4].surface.known());
}

// Given a door leaf 1 cm thick, seen from above first and then from below; noise puts returns of the one side nearer
// to the vertices of the other.
TEST_F(SurfaceCloud, ShowsTheSideOfASheetThatWasSeen) {
  SyntheticMesh mesh;
  mesh.add_patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1F);
  mesh.add_patch({0, 0, -0.01F}, {0, 1, 0}, {1, 0, 0}, 0.1F);
  keep(mesh);
  keep(std::vector<CloudPoint>{{0.5F, 0.5F, -0.02F, 1, 2.5}, {0.5F, 0.5F, 0.02F, 1, 3.5}});
  const std::vector<StampedPose> path{{RigTime::from_seconds(2.5), {Eigen::Matrix3d::Identity(), {0, 0, 1}}},
                                      {RigTime::from_seconds(3.5), {Eigen::Matrix3d::Identity(), {0, 0, -1}}}};
  const auto points = told({}, path);
  EXPECT_EQ(normal_of(points[0]).z(), 1);
  EXPECT_EQ(normal_of(points[1]).z(), -1);
}

// A shelf that a sensor on a mast sees from above while the body, and another sensor on it, are below.
TEST_F(SurfaceCloud, IsSeenFromTheSensors) {
  SyntheticMesh mesh;
  mesh.add_patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1F);
  keep(mesh);
  keep(std::vector<CloudPoint>{{0.5F, 0.5F, 0, 1, 2.5}});
  const std::vector<StampedPose> path{{RigTime::from_seconds(2.5), {Eigen::Matrix3d::Identity(), {0, 0, -1}}}};
  sensors_ = {{0, 0, 0.2}, {0, 0, 2}};
  EXPECT_EQ(normal_of(told({}, path)[0]).z(), 1);
}

// Of a thin sheet that was meshed from one side alone, a return from the other side.
TEST_F(SurfaceCloud, IsTurnedWhereOnlyTheFarSideIsKnown) {
  SyntheticMesh mesh;
  mesh.add_patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1F);
  keep(mesh);
  keep(std::vector<CloudPoint>{{0.5F, 0.5F, -0.01F, 1, 2.5}});
  const std::vector<StampedPose> path{{RigTime::from_seconds(2.5), {Eigen::Matrix3d::Identity(), {0, 0, -1}}}};
  const CloudPoint point = told({}, path)[0];
  EXPECT_EQ(normal_of(point).z(), -1);
  EXPECT_FLOAT_EQ(point.surface.variance_m2, 1e-4F);
}

// Vertices are red where x < 0.5 m and were not seen where y > 0.8 m.
TEST_F(SurfaceCloud, HasTheColoursOfItsSurfaces) {
  SyntheticMesh mesh;
  mesh.add_patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1F);
  std::vector<VertexColour> colours;
  for (const MeshVertex& v : mesh.vertices)
    colours.push_back(v.position_m.y() > 0.8F   ? VertexColour{}
                      : v.position_m.x() < 0.5F ? VertexColour{200, 10, 20, 4}
                                                : VertexColour{10, 20, 200, 5});
  keep(mesh, colours);
  keep(std::vector<CloudPoint>{{0.22F, 0.33F, 0.01F, 1, 0.5},
                               {0.22F, 0.33F, 0.01F, 1, 2.5},
                               {0.77F, 0.55F, -0.01F, 2, 2.6},
                               {0.22F, 0.97F, 0, 3, 2.7},
                               {0.22F, 0.33F, 0.2F, 4, 2.8}});
  std::vector<VertexColour> found;
  for (const CloudPoint& point : told({}, {}, true)) found.push_back(point.colour);
  EXPECT_EQ(found, (std::vector<VertexColour>{{}, {200, 10, 20, 4}, {10, 20, 200, 5}, {}, {}}));
  EXPECT_TRUE(points_of(cloud_)[3].surface.known()) << "a surface that no camera saw is one";
  EXPECT_TRUE(CloudReader::open(cloud_)->fields().colour);
}

// Two sub-meshes one after the other at one place: each point goes by that of its time. The second is damaged away.
TEST_F(SurfaceCloud, GoesByTheSubmeshOfItsTimeAndLivesWithoutOne) {
  SyntheticMesh mesh;
  mesh.add_patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1F);
  keep(mesh);
  keep(std::vector<CloudPoint>{{0.5F, 0.5F, 0, 1, 2.5}, {0.5F, 0.5F, 0, 1, 3.5}});
  const auto archive = Archive::open(folder_ / "map.db");
  constexpr std::int64_t kMissing = 17;
  const std::vector<PlacedSubmesh> placed{{kBegin, 0, {}}, {RigTime::from_seconds(3), kMissing, {}}};
  ASSERT_TRUE(add_surfaces(cloud_, *archive, {.submeshes = placed, .radius_m = kRadius_m}).ok());
  const auto points = points_of(cloud_);
  EXPECT_TRUE(points[0].surface.known());
  EXPECT_FALSE(points[1].surface.known());
}

TEST_F(SurfaceCloud, StaysAsItWasWhenItCannotBeRead) {
  keep(SyntheticMesh());
  keep(std::vector<CloudPoint>(1000));
  std::filesystem::resize_file(cloud_, 10'000);
  const std::string before = test::read_file(cloud_);
  const auto archive = Archive::open(folder_ / "map.db");
  const Status done = add_surfaces(cloud_, *archive, {.radius_m = kRadius_m});
  ASSERT_FALSE(done.ok());
  EXPECT_NE(done.error().message.find("truncated"), std::string::npos);
  EXPECT_EQ(test::read_file(cloud_), before);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cloud.ply.part"));
}

}  // namespace
}  // namespace lxd::backend_cloud_surface_test
