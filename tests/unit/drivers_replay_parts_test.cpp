// SPDX-License-Identifier: Apache-2.0
// The small parts of replay: arctangent, time stamps, KITTI's geometry.
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "drivers/replay/kitti_geometry.hpp"
#include "drivers/replay/options.hpp"
#include "drivers/replay/times_file.hpp"
#include "tests/support/replay_files.hpp"

namespace lxd::drivers_replay_parts_test {
namespace {

TEST(FastAtan2, AgreesWithTheLibraryAllAround) {
  double worst = 0;
  for (const float radius : {1e-3F, 1.0F, 120.0F}) {
    for (int i = 0; i < 200'000; ++i) {
      const double angle = 2 * std::numbers::pi * i / 200'000;
      const float x = radius * static_cast<float>(std::cos(angle)), y = radius * static_cast<float>(std::sin(angle));
      worst = std::max(worst, std::abs(std::remainder(fast_atan2(y, x) - std::atan2(y, x), 2 * std::numbers::pi)));
    }
  }
  EXPECT_LT(worst, 1e-5);
}

TEST(FastAtan2, AxesAndOrigin) {
  constexpr float kPi = std::numbers::pi_v<float>;
  EXPECT_NEAR(fast_atan2(0, 1), 0, 1e-6);
  EXPECT_NEAR(fast_atan2(1, 0), kPi / 2, 1e-6);
  EXPECT_NEAR(fast_atan2(-1, 0), -kPi / 2, 1e-6);
  EXPECT_NEAR(fast_atan2(0, -1), kPi, 1e-6);
  EXPECT_NEAR(fast_atan2(-0.0F, -1), -kPi, 1e-6);
  EXPECT_EQ(fast_atan2(0, 0), 0);
}

TEST(KittiTurn, RunsClockwiseFromBehind) {
  EXPECT_NEAR(kitti_turn_fraction(-10, 0.001F), 0, 1e-4);
  EXPECT_NEAR(kitti_turn_fraction(0, 10), 0.25, 1e-5);  // left
  EXPECT_NEAR(kitti_turn_fraction(10, 0), 0.5, 1e-5);
  EXPECT_NEAR(kitti_turn_fraction(0, -10), 0.75, 1e-5);  // right
  EXPECT_NEAR(kitti_turn_fraction(-10, -0.001F), 1, 1e-4);
}

// The published correction turns p about p x z by the angle; ours must do the same without the axis.
TEST(ElevationCorrection, IsTheRotationAboutPCrossZ) {
  const double angle = kKittiVerticalAngleCorrection_rad;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(10, 3, -1.7), Eigen::Vector3d(-4, 40, 2), Eigen::Vector3d(-1, -1, 9)}) {
    const Eigen::Vector3d axis = p.cross(Eigen::Vector3d::UnitZ()).normalized();
    const Eigen::Vector3d wanted =
        p * std::cos(angle) + axis.cross(p) * std::sin(angle);  // Rodrigues, axis normal to p
    float x = static_cast<float>(p.x()), y = static_cast<float>(p.y()), z = static_cast<float>(p.z());
    ElevationCorrection(angle).apply(x, y, z);
    EXPECT_NEAR(x, wanted.x(), 1e-5);
    EXPECT_NEAR(y, wanted.y(), 1e-5);
    EXPECT_NEAR(z, wanted.z(), 1e-5);
    EXPECT_GT(z, p.z());
  }
}

TEST(ElevationCorrection, PointOnTheAxisStays) {
  float x = 0, y = 0, z = 5;
  ElevationCorrection(0.1).apply(x, y, z);
  EXPECT_EQ(x, 0);
  EXPECT_EQ(z, 5);
}

TEST(ParseSeconds, DecimalsAreExactToTheNanosecond) {
  EXPECT_EQ(parse_seconds("1317042272.123456789")->ns(), 1317042272123456789);
  EXPECT_EQ(parse_seconds("0.1")->ns(), 100'000'000);
  EXPECT_EQ(parse_seconds("-0.5")->ns(), -500'000'000);
  EXPECT_EQ(parse_seconds("12")->ns(), 12 * kNanosPerSecond);
  EXPECT_EQ(parse_seconds("1.036224e-01")->ns(), 103'622'400);
  for (const char* bad : {"", ".", "x", "1.2.3", "nan", "inf", "1e300", "99999999999", "1 2", "--1", "0x1"}) {
    EXPECT_FALSE(parse_seconds(bad).has_value()) << bad;
  }
}

TEST(ParseDate, IsNanosecondsSince1970) {
  EXPECT_EQ(parse_date("1970-01-01 00:00:01.000000002")->ns(), 1'000'000'002);
  EXPECT_EQ(parse_date("2011-09-26 13:04:32.335337762")->ns(), 1317042272335337762);
  for (const char* bad :
       {"2011-13-26 13:04:32.3", "2011-02-30 13:04:32.3", "2011-09-26 24:04:32.3", "2011-09-26T13:04:32",
        "2011-09-26 13:04:3", "2011-09-26 13:04:32x", "2011-09-26 13:04:32.1e3"}) {
    EXPECT_FALSE(parse_date(bad).has_value()) << bad;
  }
}

TEST(TimesFile, ErrorNamesFileAndLine) {
  const test::TemporaryFolder folder;
  replay_test::write_text(folder.path() / "times.txt", "0.1\n0.2\n\n0.x\n");
  const auto stamps = read_seconds_file(folder.path() / "times.txt");
  ASSERT_FALSE(stamps.ok());
  EXPECT_NE(stamps.error().message.find("times.txt: line 4: found \"0.x\", wanted seconds"), std::string::npos);
}

TEST(TimesFile, BlankLinesAreMissingStampsExceptAtTheEnd) {
  const test::TemporaryFolder folder;
  replay_test::write_text(folder.path() / "times.txt", "0.1\r\n\r\n0.3\n\n\n");
  const auto stamps = read_seconds_file(folder.path() / "times.txt");
  ASSERT_TRUE(stamps.ok());
  ASSERT_EQ(stamps->size(), 3U);
  EXPECT_FALSE((*stamps)[1].has_value());
  EXPECT_EQ((*stamps)[2]->ns(), 300'000'000);
}

}  // namespace
}  // namespace lxd::drivers_replay_parts_test
