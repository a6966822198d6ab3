// SPDX-License-Identifier: Apache-2.0
// Clouds: written while their length is unknown, read back, converted; every format read by offsets of its own.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "backend/cloud.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::backend_cloud_test {
namespace {

using test::number_at;
using test::TemporaryFolder;

CloudPoint point(int i) {
  const auto f = static_cast<float>(i);
  return {100 + 0.5F * f, -f, 0.25F * f, f / 100, 1.7e9 + 0.1 * i};
}

// Three sweeps of 33,000 points: more than one buffer of the writer and several chunks of the reader.
constexpr int kSweeps = 3;
constexpr int kSweepPoints = 33'000;

class CloudFile : public ::testing::Test {
 protected:
  void SetUp() override {
    auto writer = CloudWriter::create(folder_ / "cloud.ply");
    ASSERT_TRUE(writer.ok());
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      std::vector<CloudPoint> points;
      for (int i = 0; i < kSweepPoints; ++i) points.push_back(point((sweep * kSweepPoints + i) % 100));
      ASSERT_TRUE(writer->append(points).ok());
    }
    ASSERT_FALSE(std::filesystem::exists(folder_ / "cloud.ply")) << "not before it is whole";
    ASSERT_TRUE(writer->close().ok());
  }
  TemporaryFolder folder_;
};

TEST_F(CloudFile, CountIsPatchedIntoTheHead) {
  const std::string bytes = test::read_file(folder_ / "cloud.ply");
  EXPECT_NE(bytes.find("\nelement vertex 99000\n"), std::string::npos);
  const std::string end = "end_header\n";
  const std::size_t data = bytes.find(end) + end.size();
  ASSERT_EQ(bytes.size(), data + 99'000 * 24);
  EXPECT_FLOAT_EQ(number_at<float>(bytes, data + 24 * 7), point(7).x_m);
  EXPECT_DOUBLE_EQ(number_at<double>(bytes, data + 24 * 7 + 16), point(7).time_s);
}

TEST_F(CloudFile, ReadsBackInChunks) {
  auto reader = CloudReader::open(folder_ / "cloud.ply");
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  std::size_t seen = 0, chunks = 0;
  const Status read = reader->for_each_chunk([&](std::span<const CloudPoint> points) {
    for (const CloudPoint& p : points) EXPECT_EQ(p.y_m, point(static_cast<int>(seen++ % 100)).y_m);
    ++chunks;
    return success();
  });
  EXPECT_TRUE(read.ok());
  EXPECT_EQ(seen, 99'000U);
  EXPECT_GT(chunks, 1U);
}

TEST_F(CloudFile, PcdHoldsTheSamePoints) {
  ASSERT_TRUE(export_cloud(folder_ / "cloud.ply", folder_ / "cloud.pcd").ok());
  const std::string bytes = test::read_file(folder_ / "cloud.pcd");
  EXPECT_NE(bytes.find("\nPOINTS 99000\n"), std::string::npos);
  const std::string end = "DATA binary\n";
  const std::size_t data = bytes.find(end) + end.size();
  ASSERT_EQ(bytes.size(), data + 99'000 * 24);
  EXPECT_FLOAT_EQ(number_at<float>(bytes, data + 24 * 42 + 8), point(42).z_m);
}

TEST_F(CloudFile, LasHoldsTheSamePointsToHalfAMillimetre) {
  ASSERT_TRUE(export_cloud(folder_ / "cloud.ply", folder_ / "cloud.las").ok());
  const std::string bytes = test::read_file(folder_ / "cloud.las");
  ASSERT_EQ(bytes.substr(0, 4), "LASF");
  ASSERT_EQ(bytes.size(), 227 + 99'000U * 28);
  EXPECT_EQ(bytes[24], 1);
  EXPECT_EQ(bytes[25], 2);
  EXPECT_EQ(number_at<std::uint16_t>(bytes, 94), 227);
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 96), 227U);
  EXPECT_EQ(bytes[104], 1) << "point format with time";
  EXPECT_EQ(number_at<std::uint16_t>(bytes, 105), 28);
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 107), 99'000U);
  EXPECT_DOUBLE_EQ(number_at<double>(bytes, 179), point(99).x_m) << "largest x";
  EXPECT_DOUBLE_EQ(number_at<double>(bytes, 187), point(0).x_m) << "smallest x";
  const std::size_t at = 227 + 28 * 42;
  for (int axis = 0; axis < 3; ++axis) {
    const double scale = number_at<double>(bytes, 131 + 8 * axis), offset = number_at<double>(bytes, 155 + 8 * axis);
    const double wanted = axis == 0 ? point(42).x_m : axis == 1 ? point(42).y_m : point(42).z_m;
    EXPECT_NEAR(number_at<std::int32_t>(bytes, at + 4 * axis) * scale + offset, wanted, 0.0005 + 1e-9);
  }
  EXPECT_EQ(number_at<std::uint16_t>(bytes, at + 12), std::lround(0.42 * 65535)) << "0..1 is spread over 16 bits";
  EXPECT_DOUBLE_EQ(number_at<double>(bytes, at + 20), point(42).time_s);
}

TEST_F(CloudFile, PlyToPlyIsTheSameFile) {
  ASSERT_TRUE(export_cloud(folder_ / "cloud.ply", folder_ / "copy.ply").ok());
  EXPECT_EQ(test::read_file(folder_ / "copy.ply"), test::read_file(folder_ / "cloud.ply"));
}

TEST_F(CloudFile, CutShortIsAnErrorThatCounts) {
  std::filesystem::resize_file(folder_ / "cloud.ply", 100'000);
  const Status converted = export_cloud(folder_ / "cloud.ply", folder_ / "cloud.pcd");
  ASSERT_FALSE(converted.ok());
  EXPECT_NE(converted.error().message.find("truncated"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cloud.pcd"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cloud.pcd.part"));
}

TEST_F(CloudFile, UnknownEndingSaysWhatIsWanted) {
  const Status converted = export_cloud(folder_ / "cloud.ply", folder_ / "cloud.xyz");
  ASSERT_FALSE(converted.ok());
  EXPECT_NE(converted.error().message.find(".las"), std::string::npos);
}

TEST(Cloud, NonFinitePointsAreLeftOut) {
  const TemporaryFolder folder;
  auto writer = CloudWriter::create(folder / "cloud.ply");
  CloudPoint bad = point(1);
  bad.z_m = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(writer->append(std::vector<CloudPoint>{point(1), bad}).ok());
  EXPECT_EQ(writer->count(), 1U);
}

TEST(Cloud, EmptyCloudConvertsToEveryFormat) {
  const TemporaryFolder folder;
  ASSERT_TRUE(CloudWriter::create(folder / "cloud.ply")->close().ok());
  for (const char* const name : {"a.ply", "a.pcd", "a.las"})
    EXPECT_TRUE(export_cloud(folder / "cloud.ply", folder / name).ok()) << name;
}

TEST(Cloud, WriterInAMissingFolderNamesItAndTheCause) {
  const auto writer = CloudWriter::create("/nonexistent/cloud.ply");
  ASSERT_FALSE(writer.ok());
  EXPECT_NE(writer.error().message.find("/nonexistent/cloud.ply"), std::string::npos);
  EXPECT_NE(writer.error().message.find("No such file"), std::string::npos);
}

}  // namespace
}  // namespace lxd::backend_cloud_test
