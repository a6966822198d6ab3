// SPDX-License-Identifier: Apache-2.0
// What is particular to one kind of folder recording: KITTI raw, KITTI odometry, generic; and telling them apart.
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/replay_layouts.hpp"

namespace lxd::source_kinds_test {
namespace {

using namespace replay_test;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

// Given a wall around the car, when the sensor turns clockwise from behind, then left comes before ahead before right.
TEST(ReplayKittiRaw, PointTimesFollowTheAzimuth) {
  RawLayout layout;
  layout.scan(0, {{-10, 0.001F, 0, 1}, {0, 10, 0, 1}, {10, 0, 0, 1}, {0, -10, 0, 1}, {-10, -0.001F, 0, 1}});
  layout.times({32});
  const auto sweeps = read_all(*must_open(layout.path()));
  ASSERT_EQ(sweeps.size(), 1U);
  EXPECT_EQ(sweeps[0].header.begin.ns(), -50'000'000);
  EXPECT_EQ(sweeps[0].header.stamp.ns(), 0);  // rig time zero: the first sweep faces forwards
  EXPECT_EQ(sweeps[0].header.end.ns(), 50'000'000);
  const std::array<double, 5> wanted_ns{0, 25e6, 50e6, 75e6, 100e6};
  for (std::size_t i = 0; i < wanted_ns.size(); ++i) EXPECT_NEAR(sweeps[0].points[i].offset_ns, wanted_ns[i], 2e3);
}

TEST(ReplayKittiRaw, MissingStartAndEndStampsBecomeHalfATurnAndANote) {
  RawLayout layout;
  for (int i = 0; i < 4; ++i) layout.good_scan(i);
  layout.times({1, 1.1, 1.2, 1.3});
  std::filesystem::remove(layout.path() / "velodyne_points" / "timestamps_start.txt");
  std::filesystem::remove(layout.path() / "velodyne_points" / "timestamps_end.txt");
  const auto source = must_open(layout.path());
  ASSERT_EQ(source->notes().size(), 2U);
  EXPECT_NE(source->notes()[0].find("timestamps_start.txt is missing"), std::string::npos);
  const auto sweeps = read_all(*source);
  ASSERT_EQ(sweeps.size(), 4U);
  EXPECT_EQ(sweeps[1].header.begin.ns(), 50'000'000);
  EXPECT_EQ(sweeps[1].header.end.ns(), 150'000'000);
}

TEST(ReplayKittiRaw, StampsThatContradictEachOtherPassTheSweepOver) {
  RawLayout layout;
  for (int i = 0; i < 3; ++i) layout.good_scan(i);
  layout.times({1, 1.1, 1.2});
  write_text(layout.path() / "velodyne_points" / "timestamps_start.txt",
             "2011-09-26 13:04:01.15\n2011-09-26 13:03:01.05\n2011-09-26 13:04:01.15\n");
  const auto source = must_open(layout.path());
  EXPECT_EQ(read_all(*source).size(), 1U);
  EXPECT_EQ(source->rejected(), (Counts{{"time_backwards", 1}, {"sweep_too_long", 1}}));
}

TEST(ReplayKittiRaw, DriveDateAndPointsFolderAllOpen) {
  RawLayout layout;
  layout.good_scan(0);
  layout.times({1});
  const test::TemporaryFolder date;
  const auto drive = date.path() / "2011_09_26_drive_0005_sync";
  std::filesystem::copy(layout.path(), drive, std::filesystem::copy_options::recursive);
  write_text(date.path() / "calib_velo_to_cam.txt", "");
  for (const auto& path : {date.path(), drive, drive / "velodyne_points", drive / ""}) {
    EXPECT_EQ(must_open(path)->kind(), "kitti-raw") << path;
  }
  std::filesystem::copy(layout.path(), date.path() / "2011_09_26_drive_0009_sync",
                        std::filesystem::copy_options::recursive);
  const std::string message = open_error(date.path());
  EXPECT_NE(message.find("found 2 recordings, wanted one"), std::string::npos) << message;
  EXPECT_NE(message.find("2011_09_26_drive_0009_sync/velodyne_points"), std::string::npos) << message;
}

TEST(ReplayKittiRaw, ElevationCorrectionRaisesPointsWhenAskedFor) {
  RawLayout layout;
  layout.scan(0, {{20, 0, 0, 1}});
  layout.times({1});
  const auto plain = read_all(*must_open(layout.path()));
  const auto raised =
      read_all(*must_open(layout.path(), {.kitti_vertical_angle_correction_rad = kKittiVerticalAngleCorrection_rad}));
  EXPECT_EQ(plain[0].points[0].z_m, 0);
  EXPECT_NEAR(raised[0].points[0].z_m, 20 * std::sin(0.205 * std::numbers::pi / 180), 1e-5);
  EXPECT_EQ(raised[0].points[0].offset_ns, plain[0].points[0].offset_ns);
}

TEST(ReplayKittiOdometry, SweepsAreInstantsAndTruthIsIgnored) {
  const test::TemporaryFolder root;
  const auto sequence = root.path() / "sequences" / "07";
  write_floats(sequence / "velodyne" / "000000.bin", {1, 2, 3, 0.5F});
  write_text(sequence / "times.txt", "1.036224e-01\n");
  write_text(sequence / "poses.txt", "not a pose\n");
  for (const auto& path : {root.path(), root.path() / "sequences", sequence}) {
    const auto sweeps = read_all(*must_open(path));
    ASSERT_EQ(sweeps.size(), 1U);
    EXPECT_EQ(sweeps[0].header.begin.ns(), 103'622'400);
    EXPECT_EQ(sweeps[0].header.begin, sweeps[0].header.end);
    EXPECT_EQ(sweeps[0].points[0].offset_ns, 0U);
  }
}

TEST(ReplayGeneric, StampIsTheTimeOfTheLastPoint) {
  GenericLayout layout;
  write_floats(layout.file(0), {1, 2, 3, 0, 0.0F, 1, 2, 3, 0, 0.09F, 1, 2, 3, 0, 0.05F});
  layout.times({1000.5});
  const auto sweeps = read_all(*must_open(layout.path()));
  ASSERT_EQ(sweeps.size(), 1U);
  EXPECT_EQ(sweeps[0].header.begin.ns(), 1'000'500'000'000);
  EXPECT_NEAR((sweeps[0].header.end - sweeps[0].header.begin).seconds(), 0.09, 1e-8);
  EXPECT_EQ(sweeps[0].header.stamp, sweeps[0].header.end);
  EXPECT_NEAR(sweeps[0].points[2].offset_ns, 50e6, 10);
}

TEST(ReplayGeneric, OffsetsOutsideTheSweepAreDropped) {
  GenericLayout layout;
  write_floats(layout.file(0), {1, 2, 3, 0, -0.001F, 1, 2, 3, 0, 1.001F, 1, 2, 3, 0, kNaN,
                                1, 2, 3, 0, kInf,    1, 2, 3, 0, 1.0F,   1, 2, 3, 0, 0.0F});
  layout.times({1});
  const auto source = must_open(layout.path());
  const auto sweeps = read_all(*source);
  ASSERT_EQ(sweeps.size(), 1U);
  EXPECT_EQ(sweeps[0].points.size(), 2U);
  EXPECT_EQ(source->rejected(), (Counts{{"bad_point_time", 4}}));
}

TEST(ReplayOpen, WrongFolderSaysWhatWasFoundAndWhatWasWanted) {
  const test::TemporaryFolder folder;
  write_text(folder.path() / "holiday.jpg", "x");
  std::filesystem::create_directories(folder.path() / "image_02");
  const std::string message = open_error(folder.path());
  for (const char* part : {"found holiday.jpg, image_02/", "velodyne_points/", "velodyne/*.bin and times.txt",
                           "lidar0/000000.bin", ".pcap"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

TEST(ReplayOpen, NothingThereSaysSo) {
  const test::TemporaryFolder folder;
  EXPECT_NE(open_error(folder.path() / "none").find("no such file or folder"), std::string::npos);
  EXPECT_NE(open_error(folder.path()).find("found nothing"), std::string::npos);
  write_text(folder.path() / "a.bin", "abc");
  EXPECT_NE(open_error(folder.path() / "a.bin").find("no packet capture"), std::string::npos);
}

TEST(ReplayOpen, TwoKindsInOneFolderAreNotGuessedBetween) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "lidar0");
  std::filesystem::create_directories(folder.path() / "velodyne");
  EXPECT_NE(open_error(folder.path()).find("found 2 recordings"), std::string::npos);
}

}  // namespace
}  // namespace lxd::source_kinds_test
