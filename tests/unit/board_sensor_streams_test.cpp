// SPDX-License-Identifier: Apache-2.0
// A recording's sensors beside the LiDAR: handed over up to a sweep's end, shifted when a recording plays again, and
// only those that are in use.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "board/sensor_streams.hpp"
#include "tests/support/inertial_journey.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::board_sensor_streams_test {
namespace {

RigTime at(double t_s) { return RigTime::from_seconds(t_s); }

class BoardSensorStreams : public testing::Test {
 protected:
  // A second of an IMU at 100 Hz and of wheels at 50 Hz, as text.
  void record() {
    std::string imu = "t,gx,gy,gz,ax,ay,az\n", wheel = "t,v_mps,yaw_rate_radps\n";
    for (int i = 0; i <= 100; ++i) imu += fmt::format("{:.3f},0,0,{},0,0,9.8\n", 10 + 0.01 * i, 1e-4 * i);
    for (int i = 0; i <= 50; ++i) wheel += fmt::format("{:.3f},1,0\n", 10 + 0.02 * i);
    test::write_file(folder_ / "imu.csv", imu);
    test::write_file(folder_ / "wheel.csv", wheel);
  }
  SensorStreams must_open(const char* sensors) {
    rig_.imu.emplace();
    rig_.wheel.emplace();
    auto streams = SensorStreams::open(folder_.path(), rig_, parse_sensor_set(sensors).value(), Star{});
    EXPECT_TRUE(streams.ok()) << (streams.ok() ? "" : streams.error().message);
    return std::move(*streams);
  }
  test::TemporaryFolder folder_;
  Rig rig_;
  test::OwnedOdometry odometry_{test::inertial_setup(true, true)};
};

TEST_F(BoardSensorStreams, GivesWhatWasMeasuredUpToATimeAndOneReadingMore) {
  record();
  SensorStreams streams = must_open("LIW");
  streams.feed(odometry_.odometry, at(10.105), Duration());
  EXPECT_EQ(odometry_->motion().inertial_until(), at(10.11));
  streams.feed(odometry_.odometry, at(10.11), Duration());  // it is there already
  EXPECT_EQ(odometry_->motion().inertial_until(), at(10.11));
  streams.feed(odometry_.odometry, at(10.112), Duration());
  EXPECT_EQ(odometry_->motion().inertial_until(), at(10.12));
}

TEST_F(BoardSensorStreams, ARecordingThatEndsIsNoError) {
  record();
  SensorStreams streams = must_open("LIW");
  for (const double t : {20.0, 21.0}) streams.feed(odometry_.odometry, at(t), Duration());
  EXPECT_EQ(odometry_->motion().inertial_until(), at(11));
}

TEST_F(BoardSensorStreams, TheShiftOfALoopIsAdded) {
  record();
  SensorStreams streams = must_open("LIW");
  streams.feed(odometry_.odometry, at(1010.105), Duration::from_seconds(1000));
  EXPECT_EQ(odometry_->motion().inertial_until(), at(1010.11));
}

TEST_F(BoardSensorStreams, WhatIsNotInUseIsNotReadAndNeedNotBeThere) {
  SensorStreams none = must_open("L");
  none.feed(odometry_.odometry, at(11), Duration());
  EXPECT_LT(odometry_->motion().inertial_until(), at(0));
  test::write_file(folder_ / "wheel.csv", "10,1,0\n");
  must_open("LW");
  const auto missing = SensorStreams::open(folder_.path(), rig_, parse_sensor_set("LIW").value(), Star{});
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message.find("imu.csv"), std::string::npos) << missing.error().message;
}

TEST_F(BoardSensorStreams, TheOdometryIsToldTheRigsNumbersOfWhatIsInUse) {
  rig_.imu.emplace();
  rig_.imu->gyroscope_noise_density = 1e-3;
  rig_.imu->accelerometer_random_walk = 2e-3;
  EXPECT_FALSE(imu_noise_of(rig_, parse_sensor_set("LW").value()));
  const auto noise = imu_noise_of(rig_, parse_sensor_set("LI").value());
  ASSERT_TRUE(noise);
  EXPECT_EQ(noise->gyro_density, 1e-3);
  EXPECT_EQ(noise->accel_walk, 2e-3);
  EXPECT_FALSE(wheel_model_of(rig_, Star{}));
}

}  // namespace
}  // namespace lxd::board_sensor_streams_test
