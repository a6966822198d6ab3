// SPDX-License-Identifier: Apache-2.0
// The overview is a picture of the right size with something in it, whatever the run was like.
#include <limits>

#include <gtest/gtest.h>

#include "backend/overview.hpp"
#include "backend/overview_raster.hpp"
#include "backend/overview_view.hpp"
#include "tests/support/picture.hpp"
#include "tests/support/synthetic_mesh.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::backend_overview_test {
namespace {

using test::Picture;
using test::read_png;
using test::SyntheticMesh;
using test::TemporaryFolder;

std::vector<StampedPose> path_of(int poses, double step_m) {
  std::vector<StampedPose> path;
  for (int i = 0; i < poses; ++i)
    path.push_back({RigTime::from_ns(i), {Eigen::Matrix3d::Identity(), {i * step_m, 0, 1}}});
  return path;
}

class Overview : public ::testing::Test {
 protected:
  Picture draw(const SyntheticMesh& mesh, std::span<const StampedPose> path) {
    auto writer = ArchiveWriter::create(folder_ / "map.db");
    const bool appended = mesh.faces.empty() || writer->append(mesh.view(0)).ok();
    EXPECT_TRUE(appended);
    EXPECT_TRUE(writer->finish().ok());
    const auto archive = Archive::open(folder_ / "map.db");
    const Status written = write_overview(folder_ / "overview.png", *archive, path, {"test", 10});
    EXPECT_TRUE(written.ok());
    return read_png(folder_ / "overview.png");
  }

  void expect_picture(const Picture& picture, std::size_t colours) {
    EXPECT_EQ(picture.width, 1800);
    EXPECT_EQ(picture.height, 900);
    EXPECT_GT(picture.colours, colours);
  }

  TemporaryFolder folder_;
};

TEST_F(Overview, ShowsARoomWithABox) {
  SyntheticMesh mesh;
  mesh.add_room({0, 0, 0}, {8, 6, 3});
  mesh.add_box({2, 2, 0}, {1, 1, 1});
  expect_picture(draw(mesh, path_of(50, 0.1)), 1000);
}

TEST_F(Overview, ShowsAPathWithoutMesh) { expect_picture(draw({}, path_of(50, 0.1)), 50); }
TEST_F(Overview, ShowsASinglePose) { expect_picture(draw({}, path_of(1, 0)), 20); }
TEST_F(Overview, ShowsAnEmptyRun) { expect_picture(draw({}, {}), 2); }

TEST_F(Overview, StandsHugeTinyAndBrokenMeshes) {
  for (const float size_m : {1e-4F, 1e6F}) {
    SyntheticMesh mesh;
    mesh.add_patch({0, 0, 0}, {size_m, 0, 0}, {0, size_m, 0}, size_m / 4);
    mesh.vertices[0].position_m.x() = std::numeric_limits<float>::quiet_NaN();
    mesh.vertices[5].position_m.y() = std::numeric_limits<float>::max();
    expect_picture(draw(mesh, path_of(20, size_m / 20)), 20);
  }
}

TEST_F(Overview, BrokenPoseIsPassedOver) {
  auto path = path_of(20, 0.5);
  path[3].T.p.x() = std::numeric_limits<double>::quiet_NaN();
  expect_picture(draw({}, path), 20);
}

TEST(Raster, NearestSurfaceStays) {
  Raster raster(4, 4);
  const auto cover = [&](double depth_m, const Colour& colour) {
    raster.triangle({Raster::Corner(-9, -9, depth_m), {20, -9, depth_m}, {-9, 20, depth_m}}, {colour, colour, colour});
  };
  EXPECT_FALSE(raster.covered(1, 1));
  cover(1, Colour(1, 0, 0));
  cover(2, Colour(0, 1, 0));
  cover(1.5, Colour(0, 0, 1));
  EXPECT_TRUE(raster.covered(1, 1));
  EXPECT_TRUE(raster.colour(1, 1).isApprox(Colour(0, 1, 0)));
}

TEST(View, FitsThePointsIntoThePanelAndKeepsRightAngles) {
  const std::vector<Eigen::Vector3d> points{{-10, -2, 0}, {10, 2, 3}, {-10, 2, 0}, {10, -2, 1}};
  const View view = fit_view(look(0.4, 0.7), points, points, {400, 300}, {800, 600});
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d at = view.project(p);
    EXPECT_TRUE(at.x() >= 0 && at.x() <= 800 && at.y() >= 0 && at.y() <= 600);
  }
  EXPECT_TRUE((view.R_view_map * view.R_view_map.transpose()).isApprox(Eigen::Matrix3d::Identity()));
  EXPECT_NEAR(view.R_view_map.determinant(), 1, 1e-12);
}

TEST(View, FromAboveShowsTheHeadingUpAndItsRightRight) {
  const Eigen::Matrix3d R = look(0, std::acos(-1.0) / 2);
  EXPECT_TRUE((R * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-9));
  EXPECT_TRUE((R * -Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
}

}  // namespace
}  // namespace lxd::backend_overview_test
