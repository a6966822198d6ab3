// SPDX-License-Identifier: Apache-2.0
// Recorded paths: read, refused with a place and a reason, and followed.
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/motion_checks.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/motion/make_motion.hpp"
#include "tools/simulator/motion/path_file.hpp"

namespace lxd::sim::simulator_path_file_test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::string_view kOxtsHeader = "t,lat_deg,lon_deg,alt_m,roll_rad,pitch_rad,yaw_rad\n";
constexpr std::string_view kViralHeader =
    "%time,field.header.seq,field.header.stamp,field.pose.position.x,field.pose.position.y,field.pose.position.z,"
    "field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,field.pose.orientation.w\n";

// A circle of 2 m radius in 20 s, facing along it, at 10 Hz.
std::string tum_circle(double duration_s) {
  std::string text = "# t x y z qx qy qz qw\n";
  for (int i = 0; i <= std::lround(10 * duration_s); ++i) {
    const double angle = 0.01 * std::numbers::pi * i, half = (angle + std::numbers::pi / 2) / 2;
    text += fmt::format("{:.3f} {:.9f} {:.9f} 0.5 0 0 {:.9f} {:.9f}\n", 1.7e9 + 0.1 * i, 2 * std::cos(angle),
                        2 * std::sin(angle), std::sin(half), std::cos(half));
  }
  return text;
}

std::string error_of(const std::string& content, std::string_view format = "auto") {
  const test::TemporaryFolder folder;
  test::write_file(folder / "path.txt", content);
  const auto path = load_path(folder / "path.txt", format);
  return path.ok() ? "none" : path.error().message;
}

void expect_error(const std::string& content, std::string_view wanted, std::string_view format = "auto") {
  const std::string message = error_of(content, format);
  EXPECT_NE(message.find(wanted), std::string::npos) << message << "\nwanted: " << wanted;
}

Result<Trajectory> follow(const std::filesystem::path& file, double duration_s, double start_s, bool moving = true) {
  MotionConfig config;
  config.carrier = "path";
  config.file = file;
  config.file_start_s = start_s;
  config.start_moving = moving;
  return make_motion(config, World{}, 1, duration_s);
}

TEST(SimulatorPathFile, TumIsRead) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.tum", tum_circle(3));
  const auto path = load_path(folder / "a.tum", "auto");
  ASSERT_TRUE(path.ok()) << path.error().message;
  EXPECT_EQ(path->format, "tum");
  EXPECT_TRUE(path->oriented);
  ASSERT_EQ(path->samples.size(), 31U);
  EXPECT_EQ(path->samples[0].t_s, 0);
  EXPECT_NEAR(path->samples[30].t_s, 3, 1e-6);
  EXPECT_EQ(path->samples[0].p, Vector3d(2, 0, 0.5));
  EXPECT_NEAR(Log(path->samples[0].q.toRotationMatrix()).z(), std::numbers::pi / 2, 1e-8);
}

TEST(SimulatorPathFile, TrackedPrismIsReadWithoutItsAttitude) {
  const test::TemporaryFolder folder;
  std::string text(kViralHeader);
  for (int i = 0; i < 12; ++i)
    text += fmt::format("1609043642{:02}6916148,{},1609043642{:02}2158030,{},2,3,0,0,0,0\n", 5 * i, i, 5 * i, 0.1 * i);
  test::write_file(folder / "a.csv", text);
  const auto path = load_path(folder / "a.csv", "auto");
  ASSERT_TRUE(path.ok()) << path.error().message;
  EXPECT_EQ(path->format, "ntu_viral");
  EXPECT_FALSE(path->oriented);
  EXPECT_NEAR(path->samples[11].t_s, 0.55, 1e-6);
  EXPECT_NEAR(path->samples[11].p.x(), 1.1, 1e-9);
}

TEST(SimulatorPathFile, OxtsIsReadInMetresEastNorthUp) {
  const test::TemporaryFolder folder;
  std::string text(kOxtsHeader);
  for (int i = 0; i < 12; ++i)
    text += fmt::format("{:.1f},{:.9f},8.4,{},0.01,0.02,1.5\n", 0.1 * i, 49 + 1e-5 * i, 110 + i);
  test::write_file(folder / "a.csv", text);
  const auto path = load_path(folder / "a.csv", "auto");
  ASSERT_TRUE(path.ok()) << path.error().message;
  EXPECT_EQ(path->format, "oxts");
  // A degree of latitude is 111.2 km long there (WGS 84).
  EXPECT_NEAR(path->samples[10].p.y(), 11.12, 0.02);
  EXPECT_NEAR(path->samples[10].p.x(), 0, 1e-6);
  EXPECT_NEAR(path->samples[10].p.z(), 10, 1e-4);
  const Eigen::Matrix3d R = path->samples[10].q.toRotationMatrix();
  EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), 1.5, 1e-9);
  EXPECT_NEAR(std::asin(-R(2, 0)), 0.02, 1e-9);
  EXPECT_NEAR(std::atan2(R(2, 1), R(2, 2)), 0.01, 1e-9);
}

TEST(SimulatorPathFile, MistakesHaveAPlaceAndAReason) {
  expect_error("1 0 0 0 0 0 0 1\n2 0 0 zero 0 0 0 1\n", "path.txt:2: column 4: found 'zero', wanted a finite number");
  expect_error("1 0 0 0 0 0 0 1\n\n2 0 0 nan 0 0 0 1\n", "path.txt:3: column 4: found 'nan'");
  expect_error("1 0 0 0 0 0 0 1\n2 0 inf 0 0 0 0 1\n", "path.txt:2: column 3: found 'inf'");
  expect_error("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n", "path.txt:2: found 7 columns, wanted 8");
  expect_error("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 0.5\n", "path.txt:2: found a quaternion of norm 0.5000, wanted 1");
  expect_error("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "path.txt:2: found time 1.000000 s, wanted later than 1.000000 s");
  expect_error("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "path.txt:2: found time 1.000000 s");
  expect_error("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n", "found 2 poses, wanted at least 10");
  expect_error("x y z\n1 2 3\n", "no known format");
  expect_error("1 2 3\n", "no known format");
  expect_error("", "no known format");
  expect_error("# only words\n", "found 0 poses", "tum");
  expect_error(std::string(kOxtsHeader) + "0,91,8,100,0,0,0\n", "path.txt:2: found latitude 91");
  expect_error(std::string(kOxtsHeader) + "0,49,8,100,0,,0\n", "path.txt:2: column 6: found ''");
  expect_error(std::string(kOxtsHeader) + "0,49,8\n", "path.txt:2: found 3 columns, wanted 7 to 18");
}

TEST(SimulatorPathFile, MissingFileAndFolderAreNamed) {
  const auto missing = load_path("/nonexistent/a.tum", "auto");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().message, "/nonexistent/a.tum: cannot be read: No such file or directory");
  const test::TemporaryFolder folder;
  const auto directory = load_path(folder.path(), "auto");
  ASSERT_FALSE(directory.ok());
  EXPECT_NE(directory.error().message.find("Is a directory"), std::string::npos) << directory.error().message;
}

TEST(SimulatorRecordedMotion, FollowsThePath) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.tum", tum_circle(30));
  const auto motion = follow(folder / "a.tum", 20, 3);
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  for (double t = -1; t < 21; t += 0.113) {
    const double angle = 0.1 * std::numbers::pi * (t + 3);
    const MotionState state = motion->at(t);
    EXPECT_LT((state.T_world_body.p - Vector3d(2 * std::cos(angle), 2 * std::sin(angle), 0.5)).norm(), 1e-3) << t;
    EXPECT_NEAR(state.v_world_mps.norm(), 0.2 * std::numbers::pi, 0.01) << t;
    EXPECT_NEAR(state.omega_body_radps.z(), 0.1 * std::numbers::pi, 0.01) << t;
  }
}

TEST(SimulatorRecordedMotion, BeginsAtRestOnRequest) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.tum", tum_circle(30));
  const auto motion = follow(folder / "a.tum", 20, 0, false);
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  for (double t = -1; t <= 2; t += 0.1) {
    EXPECT_EQ(motion->at(t).v_world_mps.norm(), 0) << t;
    EXPECT_EQ(motion->at(t).omega_body_radps.norm(), 0) << t;
  }
  EXPECT_NEAR(motion->at(10).v_world_mps.norm(), 0.2 * std::numbers::pi, 0.01);
}

TEST(SimulatorRecordedMotion, IsPutWhereItIsWanted) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.tum", tum_circle(30));
  MotionConfig config;
  config.carrier = "path";
  config.file = folder / "a.tum";
  config.origin = {10, 20, 1.5, 30 * kDegree};
  const auto motion = make_motion(config, World{}, 1, 10);
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  const Pose start = motion->pose(0);
  EXPECT_LT((start.p - Vector3d(10, 20, 1.5)).norm(), 1e-6);
  EXPECT_NEAR(std::atan2(start.R(1, 0), start.R(0, 0)), 30 * kDegree, 1e-6);
}

TEST(SimulatorRecordedMotion, LevellingTurnsTheWholePath) {
  RecordedPath path{"tum", {}, true};
  const Eigen::Quaterniond slope(Exp(Vector3d(0.1, -0.2, 0)));
  for (int i = 0; i < 100; ++i)
    path.samples.push_back({0.1 * i, slope * Vector3d(5 * std::cos(0.1 * i), 5 * std::sin(0.1 * i), 0), slope});
  level(path);
  for (const PathSample& sample : path.samples) {
    EXPECT_NEAR(sample.p.z(), path.samples[0].p.z(), 0.02);
    EXPECT_LT(std::acos(std::min(1.0, sample.q.toRotationMatrix()(2, 2))), 0.5 * kDegree);
  }
}

TEST(SimulatorRecordedMotion, TooShortPathsAndGapsAreRefused) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.tum", tum_circle(15));
  const auto longer = follow(folder / "a.tum", 20, 2);
  ASSERT_FALSE(longer.ok());
  EXPECT_NE(longer.error().message.find("lasts 15.0 s, wanted at least 23.3 s"), std::string::npos)
      << longer.error().message;
  const auto early = follow(folder / "a.tum", 5, 0);
  ASSERT_FALSE(early.ok());
  EXPECT_NE(early.error().message.find("motion.file_start_s: found 0, wanted at least 1.3"), std::string::npos)
      << early.error().message;
  std::string text = tum_circle(30);
  const std::size_t cut = text.find("1700000010.000"), resume = text.find("1700000012.000");
  test::write_file(folder / "b.tum", text.substr(0, cut) + text.substr(resume));
  const auto gap = follow(folder / "b.tum", 10, 5);
  ASSERT_FALSE(gap.ok());
  EXPECT_NE(gap.error().message.find("no pose between 9.9 s and 12.0 s"), std::string::npos) << gap.error().message;
  EXPECT_TRUE(follow(folder / "b.tum", 5, 15).ok());
}

struct RealPath {
  const char* name;
  double start_s, duration_s;
  double position_rms_m, angle_rms_deg;  // of the poses from the curve, at most
  double speed_max_mps;
};

// Followed as a scenario would: smooth enough to be integrated, near enough to what was recorded.
class SimulatorRealPaths : public ::testing::TestWithParam<RealPath> {};

TEST_P(SimulatorRealPaths, AreFollowed) {
  const char* const data = std::getenv("LXD_SHARED_DATA");
  if (data == nullptr) GTEST_SKIP() << "LXD_SHARED_DATA is not set";
  const std::filesystem::path packed = std::filesystem::path(data) / "motion" / (std::string(GetParam().name) + ".xz");
  if (!std::filesystem::exists(packed)) GTEST_SKIP() << packed << " is missing";
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "path";
  const std::string unpack = fmt::format("xz -dc '{}' > '{}'", packed.string(), file.string());
  if (std::system(unpack.c_str()) != 0) GTEST_SKIP() << "xz is missing";

  const auto motion = follow(file, GetParam().duration_s, GetParam().start_s);
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  const auto path = load_path(file, "auto");
  double squares_m2 = 0, squares_rad2 = 0, count = 0;
  for (const PathSample& sample : path->samples) {
    const double t_s = sample.t_s - GetParam().start_s;
    if (t_s < 0 || t_s > GetParam().duration_s) continue;
    const MotionState state = motion->at(t_s);
    squares_m2 += (state.T_world_body.p - sample.p).squaredNorm();
    squares_rad2 += Log(state.T_world_body.R.transpose() * sample.q.toRotationMatrix()).squaredNorm();
    ++count;
    EXPECT_LT(state.v_world_mps.norm(), GetParam().speed_max_mps);
  }
  EXPECT_LT(std::sqrt(squares_m2 / count), GetParam().position_rms_m);
  if (path->oriented) {
    EXPECT_LT(std::sqrt(squares_rad2 / count), GetParam().angle_rms_deg * kDegree);
  }
  const test::ReckoningError error = test::reckon(*motion, 5, 10, 0.005);
  EXPECT_LT(error.position_m, 1e-4);
  EXPECT_LT(error.angle_rad, 1e-3 * kDegree);
}

INSTANTIATE_TEST_SUITE_P(All, SimulatorRealPaths,
                         ::testing::Values(RealPath{"fusionportable_v2_handheld_room01.tum", 20, 60, 0.01, 0.15, 2},
                                           RealPath{"fusionportable_v2_legged_room00.tum", 20, 60, 0.01, 0.3, 2},
                                           RealPath{"fusionportable_v2_ugv_transition00.tum", 400, 60, 0.01, 0.1, 3},
                                           RealPath{"kitti_06_oxts.csv", 5, 60, 0.01, 0.1, 16},
                                           RealPath{"kitti_09_oxts.csv", 2, 60, 0.01, 0.1, 16},
                                           RealPath{"ntu_viral_nya_01.csv", 63, 60, 0.02, 0, 2},
                                           RealPath{"ntu_viral_sbs_01.csv", 25, 60, 0.02, 0, 2}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace lxd::sim::simulator_path_file_test
