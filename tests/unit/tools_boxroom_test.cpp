// SPDX-License-Identifier: Apache-2.0
// The generated recording is exact: what is not stated noise is the world and the motion that its truth names.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "tools/boxroom/recording.hpp"
#include "tools/boxroom/sensors.hpp"

namespace lxd::boxroom::tools_boxroom_test {
namespace {

using Eigen::Vector3d;

constexpr double kNoiseMax_m = 0.06;  // six standard deviations of a range
constexpr double kBegin_s = 3.0;      // a sweep at full speed
constexpr int kBeams = 16;

// Distance from p_world to the surface of a box, from inside or outside.
double distance_m(const Box& box, const Vector3d& p_world) {
  const Vector3d below = box.low_m - p_world, above = p_world - box.high_m;
  const Vector3d outside = below.cwiseMax(above);
  const double inside_m = outside.maxCoeff();
  return inside_m < 0 ? -inside_m : outside.cwiseMax(0.0).norm();
}

double distance_m(const World& world, const Vector3d& p_world) {
  double nearest_m = distance_m(world.hall(), p_world);
  for (const Box& box : world.boxes()) nearest_m = std::min(nearest_m, distance_m(box, p_world));
  return nearest_m;
}

struct Scene {
  Motion motion{1.0, 1.0};
  Noise noise{1};
  World world{noise, motion};
  Turn turn = scan(world, motion, kBeams, kBegin_s, noise);
};

Vector3d point(std::span<const float> values) { return {values[0], values[1], values[2]}; }

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::filesystem::path fresh_folder(const std::string& name) {
  const auto folder = std::filesystem::path(testing::TempDir()) / ("lxd_boxroom_" + name);
  std::filesystem::remove_all(folder);
  return folder;
}

Options small(const std::filesystem::path& out) { return {.out = out, .sweeps = 2, .beams = 4}; }

double turn_rate_rad_s(const Motion& motion, double t_s) {
  const double step_s = 1e-4;
  const Pose before = motion.world_body(t_s - step_s), after = motion.world_body(t_s + step_s);
  return before.quaternion().angularDistance(after.quaternion()) / (2 * step_s);
}

}  // namespace

TEST(Boxroom, GivenAMovingSweepThenEveryPointLiesOnTheWorldAtItsOwnFiringTime) {
  const Scene scene;
  const std::span<const float> values(scene.turn.moving);
  ASSERT_EQ(values.size(), 5U * kBeams * kColumns);
  double worst_at_begin_m = 0;
  for (std::size_t i = 0; i < values.size(); i += 5) {
    const Vector3d p_lidar = point(values.subspan(i));
    const Pose T_world_lidar = scene.motion.world_body(kBegin_s + static_cast<double>(values[i + 4])) * body_lidar();
    ASSERT_LT(distance_m(scene.world, T_world_lidar * p_lidar), kNoiseMax_m);
    const Pose T_begin = scene.motion.world_body(kBegin_s) * body_lidar();
    worst_at_begin_m = std::max(worst_at_begin_m, distance_m(scene.world, T_begin * p_lidar));
  }
  EXPECT_GT(worst_at_begin_m, 2 * kNoiseMax_m) << "the carrier did not move, so that deskewing would not matter";
}

TEST(Boxroom, GivenAFrozenSweepThenEveryPointLiesOnTheWorldAtTheFirstFiring) {
  const Scene scene;
  const std::span<const float> values(scene.turn.frozen);
  ASSERT_EQ(values.size(), 4U * kBeams * kColumns);
  const Pose T_world_lidar = scene.motion.world_body(kBegin_s) * body_lidar();
  for (std::size_t i = 0; i < values.size(); i += 4)
    ASSERT_LT(distance_m(scene.world, T_world_lidar * point(values.subspan(i))), kNoiseMax_m);
}

TEST(Boxroom, GivenRestThenTheBodyStandsStillUntilItEnds) {
  const Motion motion(2.0, 1.0);
  EXPECT_EQ(motion.world_body(0.0).p, motion.world_body(2.0).p);
  EXPECT_EQ(motion.world_body(0.0).R, motion.world_body(2.0).R);
  EXPECT_NE(motion.world_body(0.0).p, motion.world_body(2.5).p);
}

TEST(Boxroom, GivenAngularSpeedThenTheBodyTurnsSoManyTimesAsFastOnTheSamePath) {
  const Motion standard(0.0, 1.0), fast(0.0, 3.0);
  // At full speed path time is t - 1 s: the fast motion at 5 s has the attitude that the standard one has at 13 s.
  EXPECT_EQ(standard.world_body(5.0).p, fast.world_body(5.0).p);
  EXPECT_LT((standard.world_body(13.0).R - fast.world_body(5.0).R).norm(), 1e-12);
  EXPECT_NEAR(turn_rate_rad_s(fast, 5.0), 3.0 * turn_rate_rad_s(standard, 13.0), 1e-6);
}

TEST(Boxroom, GivenRestThenTheImuFeelsGravityAndItsBiasOnly) {
  const Motion motion(1.0, 1.0);
  Noise noise(1);
  Vector3d mean_force_m_s2 = Vector3d::Zero(), mean_rate_rad_s = Vector3d::Zero();
  constexpr int kSamples = 1000;
  for (int i = 0; i < kSamples; ++i) {
    const ImuSample sample = measure(motion, 0.5, noise);
    mean_force_m_s2 += sample.specific_force_m_s2 / kSamples;
    mean_rate_rad_s += sample.angular_rate_rad_s / kSamples;
  }
  EXPECT_LT((mean_force_m_s2 - Vector3d(0.02, -0.015, 9.82)).norm(), 0.004);
  EXPECT_LT((mean_rate_rad_s - Vector3d(0.002, -0.001, 0.0015)).norm(), 0.0004);
}

TEST(Boxroom, GivenASeedThenTheRecordingIsTheSameBytesAndAnotherSeedsIsNot) {
  Options first = small(fresh_folder("first")), again = small(fresh_folder("again")),
          other = small(fresh_folder("other"));
  other.seed = 2;
  for (const Options& options : {first, again, other}) ASSERT_TRUE(write_recording(options));
  for (const char* name : {"moving/imu.csv", "moving/lidar0/000001.bin", "frozen/velodyne/000001.bin"}) {
    EXPECT_EQ(content(first.out / name), content(again.out / name)) << name;
    EXPECT_NE(content(first.out / name), content(other.out / name)) << name;
  }
}

TEST(Boxroom, GivenARecordingThenBothLayoutsAreComplete) {
  const Options options = small(fresh_folder("layout"));
  ASSERT_TRUE(write_recording(options));
  EXPECT_EQ(content(options.out / "moving/lidar0/times.txt"), "1000.000000000\n1000.100000000\n");
  EXPECT_EQ(content(options.out / "frozen/times.txt"), "0.000000000\n0.100000000\n");
  const std::string poses = content(options.out / "frozen/poses.txt");
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), options.sweeps);
  EXPECT_NE(content(options.out / "moving/rig.yaml").find("beams: 4,"), std::string::npos);
  EXPECT_EQ(content(options.out / "moving/truth.tum").substr(0, 14), "999.800000000 ");
  EXPECT_FALSE(content(options.out / "frozen/truth.tum").empty());
}

TEST(Boxroom, GivenAFolderThatCannotBeMadeThenTheErrorNamesTheFile) {
  const auto blocked = fresh_folder("blocked");
  std::ofstream(blocked) << "a file, no folder";
  const Status status = write_recording(small(blocked));
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find((blocked / "world.ply").string()), std::string::npos);
}

}  // namespace lxd::boxroom::tools_boxroom_test
