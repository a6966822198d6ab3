// SPDX-License-Identifier: Apache-2.0
// The star of extrinsics around the chosen body, and the covariance of the frame that is published.
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "board/star.hpp"

namespace lxd::board_star_test {
namespace {

Pose pose(double yaw_rad, double x, double y, double z) {
  return {Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {x, y, z}};
}

bool near(const Pose& a, const Pose& b) { return a.R.isApprox(b.R, 1e-12) && (a.p - b.p).norm() < 1e-12; }

Rig full_rig() {
  Rig rig;
  rig.reference = "base_link";
  rig.lidar0.T_reference_sensor = pose(0.3, 1, 2, 3);
  rig.imu.emplace().T_reference_sensor = pose(-0.7, 0.1, 0, 0);
  rig.wheel.emplace().T_reference_sensor = pose(0.1, 0, 0.4, 0);
  rig.camera0.emplace().T_reference_sensor = pose(1.1, 0, 0, 0.2);
  rig.lidar1.emplace().T_reference_sensor = pose(2.0, 1, 1, 1);
  rig.gnss.emplace().antenna_in_reference_m = {0, 0, 1};
  return rig;
}

TEST(BoardStar, ChoosesTheBodyByWhatIsUsed) {
  const Rig rig = full_rig();
  const auto body = [&](std::string_view sensors) {
    return std::string(resolve_star(rig, parse_sensor_set(sensors).value()).value().body);
  };
  EXPECT_EQ(body("L"), "lidar0");
  EXPECT_EQ(body("LC"), "camera0");
  EXPECT_EQ(body("LCW"), "wheel");
  EXPECT_EQ(body("LLCIWG"), "imu");
}

TEST(BoardStar, PublishesTheReferenceWhateverTheBody) {
  const Rig rig = full_rig();
  for (const std::string_view sensors : {"L", "LC", "LW", "LI", "LLCIWG"}) {
    const Star star = resolve_star(rig, parse_sensor_set(sensors).value()).value();
    const Pose T_lidar0_reference = star.T_body_lidar0.inverse() * star.T_body_reference;
    EXPECT_TRUE(near(T_lidar0_reference, rig.lidar0.T_reference_sensor.inverse())) << sensors;
  }
}

TEST(BoardStar, CarriesTheAntennaIntoTheBody) {
  const Rig rig = full_rig();
  const Star star = resolve_star(rig, parse_sensor_set("LIG").value()).value();
  const Eigen::Vector3d back = rig.imu->T_reference_sensor * *star.antenna_in_body_m;
  EXPECT_TRUE(back.isApprox(rig.gnss->antenna_in_reference_m, 1e-12));
}

TEST(BoardStar, NamesTheSensorThatTheRigDoesNotHave) {
  Rig rig = full_rig();
  rig.wheel.reset();
  const auto star = resolve_star(rig, parse_sensor_set("LIW").value());
  ASSERT_FALSE(star);
  EXPECT_NE(star.error().message.find("no wheel"), std::string::npos) << star.error().message;
}

// Perturb the body's pose in each of its six directions and look at what the reference's pose does.
TEST(BoardStar, CovarianceOfTheReferenceAgreesWithNumericDifferentiation) {
  const Pose T_world_body = pose(0.9, 4, -2, 1);
  const Pose T_body_reference = pose(-1.3, 0.5, 0.2, -0.8);
  const Pose T = T_world_body * T_body_reference;
  constexpr double kStep = 1e-6;
  PoseCovariance J;
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 6, 1> d = Eigen::Matrix<double, 6, 1>::Zero();
    d[i] = kStep;
    const Eigen::Vector3d angle = d.head<3>();
    Pose moved = T_world_body;
    if (angle.norm() > 0) moved.R = moved.R * Eigen::AngleAxisd(angle.norm(), angle.normalized()).toRotationMatrix();
    moved.p += d.tail<3>();
    const Pose moved_reference = moved * T_body_reference;
    const Eigen::AngleAxisd turned(Eigen::Matrix3d(T.R.transpose() * moved_reference.R));
    J.col(i) << turned.axis() * turned.angle() / kStep, (moved_reference.p - T.p) / kStep;
  }
  Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Identity();
  root(0, 4) = 0.3;
  root(2, 5) = -0.6;
  const PoseCovariance of_body = root * root.transpose();
  const PoseCovariance expected = J * of_body * J.transpose();
  EXPECT_TRUE(carry_covariance(T_world_body, T_body_reference, of_body).isApprox(expected, 1e-5));
}

TEST(BoardSensorSet, AreThirtyTwoAndReadBackAsWritten) {
  int count = 0;
  for (int bits = 0; bits < 32; ++bits) {
    const SensorSet set{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0};
    count += parse_sensor_set(text_of(set)).value() == set ? 1 : 0;
  }
  EXPECT_EQ(count, 32);
}

TEST(BoardSensorSet, RefusesWhatIsNoSet) {
  for (const std::string_view text : {"", "I", "IL", "LLL", "LII", "LX", "l", "L ", "LIL"}) {
    EXPECT_FALSE(parse_sensor_set(text).ok()) << text;
  }
}

}  // namespace
}  // namespace lxd::board_star_test
