// SPDX-License-Identifier: Apache-2.0
// Path files, character by character where readers are strict.
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "backend/trajectory_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::backend_trajectory_test {
namespace {

StampedPose half_turn() {
  StampedPose pose{RigTime::from_ns(1'684'567'182'821'034'193), {}};
  pose.T.R = Eigen::AngleAxisd(-2.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.T.p = {1, -2.5, 0.123456789};
  return pose;
}

TEST(TumLine, KeepsEveryNanosecondAndEndsWithoutABlank) {
  const std::string line = tum_line(half_turn());
  EXPECT_EQ(line.substr(0, 61), "1684567182.821034193 1.000000000 -2.500000000 0.123456789 0.0");
  EXPECT_EQ(line.back(), '\n');
  EXPECT_NE(line[line.size() - 2], ' ');
}

TEST(TumLine, QuaternionIsOfUnitLengthWithPositiveW) {
  std::istringstream words(tum_line(half_turn()));
  double skip = 0, x = 0, y = 0, z = 0, w = 0;
  words >> skip >> skip >> skip >> skip >> x >> y >> z >> w;
  EXPECT_NEAR(x * x + y * y + z * z + w * w, 1, 1e-11);
  EXPECT_GE(w, 0);
  EXPECT_NEAR(z, std::sin(-1.25), 1e-11);
}

TEST(TumLine, TimesBeforeZeroKeepTheirSign) {
  EXPECT_TRUE(tum_line({RigTime::from_ns(-1), {}}).starts_with("-0.000000001 "));
}

TEST(KittiLine, IsTheUpperThreeRows) {
  std::istringstream words(kitti_line(half_turn()));
  std::vector<double> n;
  for (double value = 0; words >> value;) n.push_back(value);
  ASSERT_EQ(n.size(), 12U);
  EXPECT_NEAR(n[0], std::cos(-2.5), 1e-11);
  EXPECT_NEAR(n[1], -std::sin(-2.5), 1e-11);
  EXPECT_DOUBLE_EQ(n[7], -2.5);
}

TEST(CovarianceLine, HoldsTheUpperTriangle) {
  PoseCovariance covariance = PoseCovariance::Zero();
  covariance.diagonal() << 1, 2, 3, 4, 5, 6;
  covariance(0, 5) = covariance(5, 0) = 0.5;
  std::istringstream words(covariance_line(RigTime::from_ns(0), covariance));
  std::vector<double> n;
  for (double value = 0; words >> value;) n.push_back(value);
  ASSERT_EQ(n.size(), 22U);
  EXPECT_DOUBLE_EQ(n[1], 1);
  EXPECT_DOUBLE_EQ(n[6], 0.5);
  EXPECT_DOUBLE_EQ(n[7], 2);
  EXPECT_DOUBLE_EQ(n[21], 6);
}

TEST(TrajectoryFile, ChoosesTheFormatByItsEnding) {
  const test::TemporaryFolder folder;
  const std::vector<StampedPose> poses(3, half_turn());
  ASSERT_TRUE(write_trajectory(folder / "a.tum", poses).ok());
  ASSERT_TRUE(write_trajectory(folder / "a.kitti", poses).ok());
  EXPECT_EQ(test::read_file(folder / "a.tum"), tum_line(poses[0]) + tum_line(poses[1]) + tum_line(poses[2]));
  EXPECT_EQ(test::read_file(folder / "a.kitti"), kitti_line(poses[0]) + kitti_line(poses[1]) + kitti_line(poses[2]));
  EXPECT_FALSE(write_trajectory(folder / "a.csv", poses).ok());
}

}  // namespace
}  // namespace lxd::backend_trajectory_test
