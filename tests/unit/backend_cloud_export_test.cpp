// SPDX-License-Identifier: Apache-2.0
// Surfaces and colours of clouds in every format, read back by their heads; clouds of earlier runs and of other
// programs; moved ones.
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "backend/cloud.hpp"
#include "rt/so3.hpp"
#include "tests/support/cloud_columns.hpp"

namespace lxd::backend_cloud_export_test {
namespace {

using test::CloudColumns;
using test::TemporaryFolder;

constexpr std::size_t kPoints = 40'000;  // several chunks of the reader

// Every fifth lies on no surface, every seventh was seen by no camera.
CloudPoint point(std::size_t i) {
  const auto f = static_cast<float>(i % 1000);
  CloudPoint p{100 + 0.5F * f, -f, 0.25F * f, f / 1000, 1.7e9 + 0.1 * static_cast<double>(i)};
  if (i % 5 > 0) p.surface = {0.6F * std::cos(f), 0.6F * std::sin(f), 0.8F, 1e-4F + 1e-7F * f};
  if (i % 7 > 0) p.colour = {static_cast<std::uint8_t>(i), 20, 200, static_cast<std::uint8_t>(1 + i % 9)};
  return p;
}

class ExportedCloud : public testing::TestWithParam<CloudFields> {
 protected:
  void SetUp() override {
    for (std::size_t i = 0; i < kPoints; ++i) points_.push_back(point(i));
    auto writer = CloudWriter::create(cloud_, GetParam());
    ASSERT_TRUE(writer->append(points_).ok());
    ASSERT_TRUE(writer->close().ok());
  }

  std::filesystem::path exported(const std::string& name) {
    const Status done = export_cloud(cloud_, folder_ / name);
    EXPECT_TRUE(done.ok()) << done.error().message;
    return folder_ / name;
  }

  // The surface by three names of a normal's components; as floats, to the bit.
  void expect_surfaces(CloudColumns& columns, const std::array<const char*, 3>& normal) const {
    ASSERT_EQ(columns.contains("variance"), GetParam().surface);
    for (const char* const name : normal) ASSERT_EQ(columns.contains(name), GetParam().surface) << name;
    if (!GetParam().surface) return;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const PointSurface& wanted = points_[i].surface;
      const std::array values{wanted.nx, wanted.ny, wanted.nz};
      for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_EQ(columns[normal[axis]].at(i), values[axis]) << i;
      if (wanted.known())
        ASSERT_EQ(columns["variance"].at(i), wanted.variance_m2) << i;
      else
        ASSERT_TRUE(std::isnan(columns["variance"].at(i))) << i;
    }
  }

  TemporaryFolder folder_;
  std::filesystem::path cloud_ = folder_ / "cloud.ply";
  std::vector<CloudPoint> points_;
};

TEST_P(ExportedCloud, IsTheSameAsPly) {
  auto columns = test::ply_columns(exported("out.ply"));
  EXPECT_EQ(test::read_file(folder_ / "out.ply"), test::read_file(cloud_));
  expect_surfaces(columns, {"nx", "ny", "nz"});
  ASSERT_EQ(columns.contains("views"), GetParam().colour);
  for (std::size_t i = 0; i < kPoints; ++i) {
    ASSERT_EQ(columns["x"].at(i), points_[i].x_m);
    ASSERT_EQ(columns["time"].at(i), points_[i].time_s);
    if (!GetParam().colour) continue;
    ASSERT_EQ(columns["red"].at(i), points_[i].colour.red);
    ASSERT_EQ(columns["views"].at(i), points_[i].colour.views);
  }
}

TEST_P(ExportedCloud, HasPclsNamesAsPcd) {
  auto columns = test::pcd_columns(exported("out.pcd"));
  expect_surfaces(columns, {"normal_x", "normal_y", "normal_z"});
  EXPECT_FALSE(columns.contains("curvature")) << "a variance is none";
  ASSERT_EQ(columns.contains("rgb"), GetParam().colour);
  for (std::size_t i = 0; i < kPoints; ++i) {
    ASSERT_EQ(columns["y"].at(i), points_[i].y_m);
    ASSERT_EQ(columns["time"].at(i), points_[i].time_s);
    if (!GetParam().colour) continue;
    const VertexColour& colour = points_[i].colour;
    ASSERT_EQ(columns["rgb"].at(i), colour.red * 65536.0 + colour.green * 256.0 + colour.blue);
    ASSERT_EQ(columns["views"].at(i), colour.views);
  }
}

TEST_P(ExportedCloud, HasExtraBytesAsLas) {
  auto columns = test::las_columns(exported("out.las"));
  expect_surfaces(columns, {"NormalX", "NormalY", "NormalZ"});
  ASSERT_EQ(columns.contains("red"), GetParam().colour);
  for (std::size_t i = 0; i < kPoints; ++i) {
    ASSERT_NEAR(columns["Z"].at(i), points_[i].z_m, 0.0005 + 1e-9);
    ASSERT_EQ(columns["gps_time"].at(i), points_[i].time_s);
    if (!GetParam().colour) continue;
    ASSERT_EQ(columns["green"].at(i), 257 * points_[i].colour.green);
    ASSERT_EQ(columns["user_data"].at(i), points_[i].colour.views);
  }
}

TEST_P(ExportedCloud, CutShortIsAnErrorInEveryFormat) {
  std::filesystem::resize_file(cloud_, std::filesystem::file_size(cloud_) - 1);
  for (const char* const name : {"out.ply", "out.pcd", "out.las"}) {
    const Status done = export_cloud(cloud_, folder_ / name);
    ASSERT_FALSE(done.ok()) << name;
    EXPECT_NE(done.error().message.find("truncated"), std::string::npos) << done.error().message;
    EXPECT_FALSE(std::filesystem::exists(folder_ / name)) << name;
  }
}

// Given a sweep that belongs a quarter turn to the left, then its normals turn with it, and where there is none stays
// none.
TEST_P(ExportedCloud, TurnsItsNormalsWhenItIsMoved) {
  const RigTime stamp = RigTime::from_seconds(1'700'000'000);
  const std::vector<StampedPose> from{{stamp, Pose()}};
  const std::vector<StampedPose> to{{stamp, {Exp(Eigen::Vector3d(0, 0, std::numbers::pi / 2)), {1, 2, 3}}}};
  ASSERT_TRUE(move_cloud(cloud_, from, to).ok());
  auto columns = test::ply_columns(cloud_);
  ASSERT_EQ(columns.contains("nx"), GetParam().surface);
  ASSERT_EQ(columns.contains("red"), GetParam().colour);
  ASSERT_EQ(columns["x"].size(), kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const CloudPoint& p = points_[i];
    ASSERT_NEAR(columns["x"][i], 1 - p.y_m, 1e-3);
    ASSERT_NEAR(columns["y"][i], 2 + p.x_m, 1e-3);
    if (!GetParam().surface) continue;
    ASSERT_NEAR(columns["nx"][i], -p.surface.ny, 1e-6) << i;
    ASSERT_NEAR(columns["ny"][i], p.surface.nx, 1e-6) << i;
    ASSERT_EQ(columns["nz"][i], p.surface.nz) << i;
    ASSERT_EQ(std::isnan(columns["variance"][i]), !p.surface.known()) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Fields, ExportedCloud,
                         testing::Values(CloudFields{}, CloudFields{.surface = true}, CloudFields{.colour = true},
                                         CloudFields{.surface = true, .colour = true}),
                         [](const auto& fields) {
                           return std::string(fields.param.surface ? "Surface" : "Plain") +
                                  (fields.param.colour ? "Coloured" : "");
                         });

template <typename T>
std::string bytes_of(std::initializer_list<T> values) {
  return {reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(T)};
}

CloudPoint first_point_of(const TemporaryFolder& folder, const std::string& properties, const std::string& record) {
  test::write_file(folder / "other.ply",
                   "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + properties + "end_header\n" + record);
  auto reader = CloudReader::open(folder / "other.ply");
  EXPECT_TRUE(reader.ok()) << reader.error().message;
  CloudPoint first;
  const Status read = reader->for_each_chunk([&](std::span<const CloudPoint> points) {
    first = points[0];
    return success();
  });
  EXPECT_TRUE(read.ok());
  return first;
}

// Doubles, in another order, among what the product does not know, and without a variance.
TEST(OtherProgramsCloud, HasItsNormals) {
  const TemporaryFolder folder;
  const CloudPoint p = first_point_of(
      folder,
      "property double nz\nproperty double ny\nproperty double nx\nproperty uchar quality\nproperty float x\n"
      "property float y\nproperty float z\n",
      bytes_of({0.8, -0.6, 0.0}) + '\7' + bytes_of({1.0F, 2.0F, 3.0F}));
  EXPECT_EQ(p.y_m, 2);
  EXPECT_EQ(p.surface.ny, -0.6F);
  EXPECT_EQ(p.surface.nz, 0.8F);
  EXPECT_TRUE(std::isnan(p.surface.variance_m2));
  ASSERT_TRUE(export_cloud(folder / "other.ply", folder / "out.pcd").ok());
  EXPECT_EQ(test::pcd_columns(folder / "out.pcd")["normal_y"].at(0), -0.6F);
}

TEST(OtherProgramsCloud, HasNoneWhereItsNormalIsNone) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const CloudPoint p = first_point_of(folder,
                                      "property float x\nproperty float y\nproperty float z\nproperty float nx\n"
                                      "property float ny\nproperty float nz\nproperty float variance\n",
                                      bytes_of({1.0F, 2.0F, 3.0F, nan, nan, nan, 1e-4F}));
  EXPECT_EQ(p.surface.nx, 0);
  EXPECT_FALSE(p.surface.known());
  EXPECT_TRUE(std::isnan(p.surface.variance_m2));
}

TEST(OtherProgramsCloud, HasNoSurfacesByHalfANormal) {
  const TemporaryFolder folder;
  first_point_of(folder, "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n",
                 bytes_of({1.0F, 2.0F, 3.0F, 0.6F, 0.8F}));
  EXPECT_FALSE(CloudReader::open(folder / "other.ply")->fields().surface);
}

}  // namespace
}  // namespace lxd::backend_cloud_export_test
