// SPDX-License-Identifier: Apache-2.0
// A camera that is mounted otherwise than its rig file says gets a sentence with the transform to put there, and that
// transform is one.
#include <numbers>

#include <gtest/gtest.h>

#include "board/found_mount.hpp"
#include "board/rig_file.hpp"
#include "tests/support/cameras.hpp"

namespace lxd::board_camera_mount_test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree_rad = std::numbers::pi / 180;

// The body rolls by a right angle against the reference; the camera looks along the body's x.
Star star() {
  Star star;
  star.T_body_reference = {Exp(Vector3d(std::numbers::pi / 2, 0, 0)), {0.1, 0.2, 0.3}};
  star.T_body_camera0 = Pose{Exp(Vector3d(0, 1.2, 0)), {0.3, 0, 0.1}};
  return star;
}

FoundMount mount(const Vector3d& turned_deg, double sigma_deg) {
  FoundMount found;
  found.section = "camera0";
  found.T_reference_sensor = star().T_body_reference.inverse() * *star().T_body_camera0;
  found.T_reference_sensor.R = Exp(turned_deg * kDegree_rad) * found.T_reference_sensor.R;
  found.turned_deg = turned_deg;
  found.covariance_deg2 = sigma_deg * sigma_deg * Eigen::Matrix3d::Identity();
  return found;
}

MountHint camera_hint() {
  return {"camera0", "its images turn otherwise than the rig does (is it the inverse of what is meant?)"};
}

std::string said_of(double claimed_deg, const Vector3d& turned_deg, double sigma_deg) {
  MountHint hint = camera_hint();
  hint.note(mount(Vector3d::Zero(), claimed_deg));
  hint.note(mount(turned_deg, sigma_deg));
  return hint.sentence();
}

TEST(CameraMount, WhatTheFilterFindsIsToldInTheReferencesAxes) {
  const MountedCamera camera{CameraModel(test::radtan_camera()), *star().T_body_camera0, 0, 0, kDegree_rad};
  const FoundMount found = found_mount(CameraAlignment(camera), star());
  EXPECT_LT(found.turned_deg.norm(), 1e-9);
  EXPECT_LT((found.covariance_deg2 - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  const Pose given = star().T_body_reference.inverse() * *star().T_body_camera0;
  EXPECT_LT((found.T_reference_sensor.R - given.R).norm() + (found.T_reference_sensor.p - given.p).norm(), 1e-12);
}

// The rows that are to be copied are taken by the reader of rig files.
TEST(CameraMount, ATurnedCameraIsToldWithItsTransform) {
  const std::string said = said_of(0.5, {1, -0.5, 0.2}, 0.05);
  EXPECT_NE(said.find("camera0: it is turned by 1.14 degrees"), std::string::npos) << said;
  EXPECT_NE(said.find("(1.00, -0.50, 0.20 about the reference's axes)"), std::string::npos) << said;
  const std::size_t rows = said.find("[["), end = said.find("]]");
  ASSERT_NE(end, std::string::npos) << said;
  const RigFile file = parse_rig(
      "reference: imu\nimu: {}\nlidar0: {beams: 16, T_reference_sensor: " + said.substr(rows, end + 2 - rows) + "}\n",
      "rig.yaml");
  ASSERT_TRUE(file.ok()) << said;
  const Eigen::Matrix3d wanted = mount({1, -0.5, 0.2}, 0).T_reference_sensor.R;
  EXPECT_LT((file.rig.lidar0.T_reference_sensor.R - wanted).norm(), 1e-7);
}

TEST(CameraMount, AnExtrinsicThatIsNoneIsAskedFor) {
  MountHint hint = camera_hint();
  FoundMount found = mount({5, 0, 0}, 0.1);
  found.unlike = 0.8;
  hint.note(found);
  EXPECT_NE(hint.sentence().find("the inverse of what is meant"), std::string::npos);
}

TEST(CameraMount, WhatIsWithinTheClaimOrNotSureIsNotTold) {
  EXPECT_EQ(said_of(0.5, {0.3, 0.2, 0}, 0.01), "");
  EXPECT_EQ(said_of(2, {1, -0.5, 0.2}, 0.05), "");
  EXPECT_EQ(said_of(0.1, {0.2, 0, 0}, 0.01), "");
  EXPECT_EQ(said_of(0.5, {1, -0.5, 0.2}, 0.4), "");
  EXPECT_EQ(camera_hint().sentence(), "");
}

}  // namespace
}  // namespace lxd::board_camera_mount_test
