// SPDX-License-Identifier: Apache-2.0
// ROS 1 messages of an IMU, a receiver and a truth, by bytes put together by hand.
#include <limits>

#include "drivers/ros1/inertial.hpp"
#include "drivers/ros1/satellite_fix.hpp"
#include "drivers/ros1/truth_pose.hpp"
#include "tests/support/ros1_bytes.hpp"

namespace lxd::drivers_ros1_readings_test {
namespace {

using test::Ros1Bytes;

std::vector<std::uint8_t> inertial(double gyro_x = 0.1) {
  Ros1Bytes m;
  m.header(1'700'000'000, 5).repeat(0.0, 3).put(1.0).repeat(0.0, 9);
  m.put(gyro_x).put(0.2).put(0.3).repeat(0.0, 9).put(1.0).put(2.0).put(9.81).repeat(0.0, 9);
  return m.bytes;
}

TEST(Ros1Inertial, HasRatesForceAndTheHeadersStamp) {
  const std::vector<std::uint8_t> message = inertial();
  Ros1Inertial out;
  ASSERT_EQ(read_ros1_inertial(message, out), Ros1Fault::none);
  EXPECT_EQ(out.header.stamp.ns(), 1'700'000'000'000'000'005);
  EXPECT_EQ(out.header.frame, "s");
  EXPECT_EQ(out.gyro_radps, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(out.accel_mps2, Eigen::Vector3d(1, 2, 9.81));
}

TEST(Ros1Inertial, CutOffOrDamagedIsToldOrStood) {
  test::expect_told_when_cut(read_ros1_inertial, inertial());
  test::expect_to_stand_every_bit(read_ros1_inertial, inertial(), [](const Ros1Inertial& out) {
    EXPECT_TRUE(out.gyro_radps.allFinite() && out.accel_mps2.allFinite());
  });
}

TEST(Ros1Inertial, WithoutANumberIsRefused) {
  Ros1Inertial out;
  EXPECT_EQ(read_ros1_inertial(inertial(std::numeric_limits<double>::quiet_NaN()), out), Ros1Fault::non_finite);
}

std::vector<std::uint8_t> fix(std::int8_t status, std::uint8_t covariance_type) {
  Ros1Bytes m;
  m.header(10, 0).put(status).put(std::uint16_t{1}).put(47.5).put(-8.25).put(430.0);
  m.put(4.0).repeat(0.0, 3).put(9.0).repeat(0.0, 3).put(25.0).put(covariance_type);
  return m.bytes;
}

TEST(Ros1SatelliteFix, HasPlaceQualityAndSigmas) {
  Ros1SatelliteFix out;
  ASSERT_EQ(read_ros1_satellite_fix(fix(1, 2), out), Ros1Fault::none);
  EXPECT_EQ(out.fix.quality, GnssQuality::differential);
  EXPECT_EQ(out.fix.latitude_deg, 47.5);
  EXPECT_EQ(out.fix.longitude_deg, -8.25);
  EXPECT_EQ(out.fix.ellipsoid_height_m(), 430.0);
  EXPECT_EQ(out.fix.sigma_longitude_m, 2.0);
  EXPECT_EQ(out.fix.sigma_latitude_m, 3.0);
  EXPECT_EQ(out.fix.sigma_altitude_m, 5.0);
}

TEST(Ros1SatelliteFix, KnowsWhatItDoesNotKnow) {
  Ros1SatelliteFix out;
  ASSERT_EQ(read_ros1_satellite_fix(fix(0, 0), out), Ros1Fault::none);
  EXPECT_FALSE(out.fix.sigma_latitude_m);
  ASSERT_EQ(read_ros1_satellite_fix(fix(-1, 2), out), Ros1Fault::none);
  EXPECT_FALSE(out.fix.has_position());
}

TEST(Ros1SatelliteFix, CutOffOrDamagedIsToldOrStood) {
  test::expect_told_when_cut(read_ros1_satellite_fix, fix(0, 2));
  test::expect_to_stand_every_bit(read_ros1_satellite_fix, fix(0, 2), [](const Ros1SatelliteFix& out) {
    if (out.fix.has_position()) {
      EXPECT_LE(std::abs(*out.fix.latitude_deg), 90);
    }
  });
}

TEST(Ros1Sentence, IsALineOfTheReceiver) {
  Ros1Bytes m;
  m.header(1, 0).text("$GNZDA,*00");
  Ros1Sentence out;
  ASSERT_EQ(read_ros1_sentence(m.bytes, out), Ros1Fault::none);
  EXPECT_EQ(out.text, "$GNZDA,*00");
  test::expect_told_when_cut(read_ros1_sentence, m.bytes);
  test::expect_to_stand_every_bit(read_ros1_sentence, m.bytes,
                                  [](const Ros1Sentence& said) { EXPECT_FALSE(said.text.empty()); });
}

void put_place(Ros1Bytes& m) { m.put(1.0).put(2.0).put(3.0).put(0.0).put(0.6).put(0.0).put(0.8); }

void expect_place(const Ros1TruthPose& out) {
  EXPECT_EQ(out.p, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(out.q.w(), 0.8, 1e-15);
  EXPECT_NEAR(out.q.y(), 0.6, 1e-15);
}

void expect_sound(Ros1Fault (*read)(Ros1Reader::Bytes, Ros1TruthPose&), const std::vector<std::uint8_t>& bytes) {
  Ros1TruthPose out;
  ASSERT_EQ(read(bytes, out), Ros1Fault::none);
  expect_place(out);
  test::expect_told_when_cut(read, bytes);
  test::expect_to_stand_every_bit(read, bytes, [](const Ros1TruthPose& pose) { EXPECT_NEAR(pose.q.norm(), 1, 1e-9); });
}

TEST(Ros1TruthPose, OfAllThreeTypesIsTheSame) {
  Ros1Bytes pose, transform, odometry;
  put_place(pose.header(3, 4));
  put_place(transform.header(3, 4).text("base"));
  put_place(odometry.header(3, 4).text("base"));
  odometry.repeat(0.0, 36 + 6 + 36);
  expect_sound(read_ros1_pose, pose.bytes);
  expect_sound(read_ros1_transform, transform.bytes);
  expect_sound(read_ros1_odometry, odometry.bytes);
}

TEST(Ros1TruthPose, ThatIsNoRotationIsRefused) {
  Ros1Bytes m;
  m.header(1, 1).repeat(0.0, 7);
  Ros1TruthPose out;
  EXPECT_EQ(read_ros1_pose(m.bytes, out), Ros1Fault::non_finite);
}

}  // namespace
}  // namespace lxd::drivers_ros1_readings_test
