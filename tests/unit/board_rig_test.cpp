// SPDX-License-Identifier: Apache-2.0
// A rig file is read whole: what it says, what it leaves out, and how the loader speaks of both.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "board/rig_file.hpp"
#include "board/rig_text.hpp"

namespace lxd::board_rig_test {
namespace {

// A spinning LiDAR tilted on an IMU, as a recording of a hall with boxes has it.
constexpr std::string_view kGoodRig = R"(reference: imu
notes: {made by: hand, numbers: [1, 2], anything: {at: all}}
imu: {update_rate: 200, gyroscope_noise_density: 1.061e-4, accelerometer_noise_density: 1.414e-3}
lidar0: {model: spinning, beams: 32, columns: 1024, rate_hz: 10, fov_deg: [-25, 15], range_m: [0.3, 80], range_sigma_m: 0.01,
  T_reference_sensor: [[0.994556446984034, -0.0998334166468282, 0.029845647641081, 0.05], [0.0997884949786138, 0.995004165278026, 0.00299455326924577, -0.03], [-0.0299955002024957, 0, 0.999550033748988, 0.12], [0, 0, 0, 1]]}
)";

constexpr std::string_view kEverything = R"(%YAML:1.0
---
reference: base_link
imu:
  update_rate: 400
  protocol: witmotion
  delay_s: 0.004
  delay_sigma_s: 0
  baud_rate: 9600
  T_reference_sensor: [1, 0, 0, 0,  0, 1, 0, 0,  0, 0, 1, 0.5,  0, 0, 0, 1]
lidar0:
  model: livox
  rate_hz: 20
  T_reference_sensor: !!opencv-matrix
    rows: 4
    cols: 4
    dt: d
    data: [0, -1, 0, 1,  1, 0, 0, 2,  0, 0, 1, 3,  0, 0, 0, 1]
lidar1: {beams: 16, columns: 512, T_reference_sensor: [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}
camera0:
  camera_model: pinhole
  distortion_model: radtan
  resolution: [640, 480]
  intrinsics: [400.5, 401, 320, 240]
  distortion_coeffs: [-0.28, 0.07, 1e-4, 2e-5]
  rate_hz: 20
  T_reference_sensor: [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]
wheel: {rate_hz: 100, protocol: toyota, track_m: 1.57, speed_sigma_mps: 0.1, yaw_rate_sigma_radps: 0.02, T_reference_sensor: [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}
gnss: {rate_hz: 1, antenna_in_reference_m: [0.1, 0.2, 0.3]}
settings:
  estimator.range_max_m: 60
  threads: 1
)";

RigFile parse(std::string_view text) { return parse_rig(std::string(text), "rig.yaml"); }

TEST(BoardRig, ReadsTheKeysOfAGoodFile) {
  const RigFile file = parse(kGoodRig);
  ASSERT_TRUE(file.ok()) << text_of(file.problems);
  EXPECT_EQ(file.rig.reference, "imu");
  ASSERT_TRUE(file.rig.imu);
  EXPECT_EQ(file.rig.imu->gyroscope_noise_density, 1.061e-4);
  EXPECT_EQ(file.rig.lidar0.beams, 32U);
  EXPECT_EQ(file.rig.lidar0.fov_deg.value()[0], -25);
  EXPECT_EQ(file.rig.lidar0.range_m.value()[1], 80);
  EXPECT_EQ(file.rig.lidar0.T_reference_sensor.p.z(), 0.12);
  EXPECT_FALSE(file.rig.lidar1 || file.rig.camera0 || file.rig.wheel || file.rig.gnss);
  EXPECT_TRUE(file.remarks.empty()) << file.remarks.front();
}

TEST(BoardRig, KeepsTheDefaultsOfWhatIsLeftOut) {
  const RigFile file = parse(kGoodRig);
  ASSERT_TRUE(file.rig.imu);
  EXPECT_EQ(file.rig.imu->gyroscope_random_walk, ImuRig{}.gyroscope_random_walk);
}

TEST(BoardRig, ReadsEverySensorAndEveryWayToWriteAMatrix) {
  const RigFile file = parse(kEverything);
  ASSERT_TRUE(file.ok()) << text_of(file.problems);
  EXPECT_EQ(file.rig.imu->T_reference_sensor.p.z(), 0.5);
  EXPECT_EQ(file.rig.lidar0.T_reference_sensor.p, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(file.rig.lidar0.T_reference_sensor.R(0, 1), -1);
  EXPECT_EQ(file.rig.camera0->resolution[1], 480U);
  EXPECT_EQ(file.rig.wheel->speed_sigma_mps, 0.1);
  EXPECT_EQ(file.rig.gnss->antenna_in_reference_m.y(), 0.2);
  ASSERT_EQ(file.settings.size(), 2U);
  EXPECT_EQ(file.settings[0].key, "estimator.range_max_m");
  EXPECT_EQ(file.settings[0].value, "60");
}

TEST(BoardRig, ReadsHowSensorsSpeak) {
  const RigFile file = parse_rig(std::string(kEverything), "rig.yaml");
  ASSERT_TRUE(file.ok()) << text_of(file.problems);
  EXPECT_EQ(file.rig.imu->protocol, "witmotion");
  EXPECT_EQ(file.rig.imu->baud_rate, 9600);
  EXPECT_EQ(file.rig.imu->delay_s, 0.004);
  EXPECT_EQ(file.rig.imu->delay_sigma_s, 0);
  EXPECT_EQ(file.rig.wheel->protocol, "toyota");
  EXPECT_EQ(file.rig.wheel->track_m, 1.57);
  const RigFile other = parse_rig("imu: {protocol: nmea}\nwheel: {track_m: 570}\nlidar0: {}\n", "rig.yaml");
  const std::string said = text_of(other.problems);
  EXPECT_NE(
      said.find("imu.protocol: found 'nmea', wanted vectornav or vectornav-ascii or witmotion or microstrain or xsens"),
      std::string::npos)
      << said;
  EXPECT_NE(said.find("is it in millimetres?"), std::string::npos) << said;
}

// As far as the filter believes two sensors of one rig to be apart, and no farther.
TEST(BoardRig, TakesTheImusDelayInSecondsUpToItsLimit) {
  EXPECT_EQ(parse("imu: {delay_s: 0.05}").rig.imu->delay_s, 0.05);
  EXPECT_EQ(parse("imu: {delay_s: -0.05, delay_sigma_s: 0.02}").rig.imu->delay_sigma_s, 0.02);
  for (const std::string_view beyond : {"imu: {delay_s: 0.051}", "imu: {delay_s: 4}", "imu: {delay_sigma_s: 0.021}"}) {
    const std::string said = text_of(parse(beyond).problems);
    EXPECT_NE(said.find("is it in milliseconds?"), std::string::npos) << beyond << ": " << said;
  }
  EXPECT_FALSE(parse("imu: {delay_s: -0.051}").ok());
  EXPECT_FALSE(parse("imu: {delay_sigma_s: -0.001}").ok());
}

TEST(BoardRig, TakesTheCamerasDelayInSecondsUpToItsLimit) {
  const auto camera = [](std::string_view keys) {
    return fmt::format("camera0: {{resolution: [640, 480], intrinsics: [420, 420, 320, 240], {}}}", keys);
  };
  EXPECT_EQ(parse(camera("rate_hz: 10")).rig.camera0->delay_sigma_s, 0.005);
  EXPECT_EQ(parse(camera("delay_s: -0.05, delay_sigma_s: 0.02")).rig.camera0->delay_s, -0.05);
  EXPECT_EQ(parse(camera("delay_s: 0.02, delay_sigma_s: 0")).rig.camera0->delay_sigma_s, 0);
  for (const std::string_view beyond : {"delay_s: 0.051", "delay_s: 20", "delay_sigma_s: 0.021"}) {
    const std::string said = text_of(parse(camera(beyond)).problems);
    EXPECT_NE(said.find("is it in milliseconds?"), std::string::npos) << beyond << ": " << said;
  }
}

TEST(BoardRig, TakesHowSureTheCamerasRotationIs) {
  const auto camera = [](std::string_view keys) {
    return fmt::format("camera0: {{resolution: [640, 480], intrinsics: [420, 420, 320, 240], {}}}", keys);
  };
  EXPECT_EQ(parse(camera("rate_hz: 10")).rig.camera0->rotation_sigma_deg, 0.5);
  EXPECT_EQ(parse(camera("rotation_sigma_deg: 0")).rig.camera0->rotation_sigma_deg, 0);
  EXPECT_FALSE(parse(camera("rotation_sigma_deg: 5.1")).ok());
  EXPECT_FALSE(parse(camera("rotation_sigma_deg: -1")).ok());
  const RigFile again = parse(rig_text(parse(camera("rotation_sigma_deg: 1.5")).rig));
  EXPECT_EQ(again.rig.camera0->rotation_sigma_deg, 1.5);
}

TEST(BoardRig, SaysThatAMissingExtrinsicIsTheIdentity) {
  const RigFile file = parse("reference: imu\nimu: {}\nlidar0: {beams: 16}\n");
  ASSERT_TRUE(file.ok()) << text_of(file.problems);
  ASSERT_EQ(file.remarks.size(), 1U);
  EXPECT_NE(file.remarks[0].find("lidar0.T_reference_sensor"), std::string::npos) << file.remarks[0];
  EXPECT_NE(file.remarks[0].find("identity"), std::string::npos) << file.remarks[0];
  EXPECT_TRUE(file.rig.lidar0.T_reference_sensor.R.isIdentity());
}

TEST(BoardRig, TakesTheLidarAsReferenceWhenNoneIsGiven) {
  const RigFile file = parse("lidar0: {}\n");
  ASSERT_TRUE(file.ok()) << text_of(file.problems);
  EXPECT_EQ(file.rig.reference, "lidar0");
  ASSERT_EQ(file.remarks.size(), 1U);
  EXPECT_NE(file.remarks[0].find("reference"), std::string::npos);
}

TEST(BoardRig, WritesTheConfigurationInForceSoThatItReadsBackTheSame) {
  for (const std::string_view text : {kGoodRig, kEverything}) {
    const RigFile first = parse(text);
    Settings settings;
    settings.estimator.range_max_m = 61.0 / 3.0;
    const std::string written = rig_text(first.rig, settings);

    const RigFile again = parse(written);
    ASSERT_TRUE(again.ok()) << text_of(again.problems) << written;
    Settings settings_again;
    for (const SettingChoice& choice : again.settings) ASSERT_TRUE(set(settings_again, choice.key, choice.value));
    EXPECT_EQ(settings_again.estimator.range_max_m, settings.estimator.range_max_m);
    EXPECT_EQ(rig_text(again.rig, settings_again), written);
  }
}

TEST(BoardRig, MakesARigOfWhatTheRecordingKnows) {
  const Rig rig = default_rig({.beams = 64, .columns = 2083, .rate_hz = 10});
  EXPECT_EQ(rig.reference, "lidar0");
  EXPECT_EQ(rig.lidar0.beams, 64U);
  EXPECT_EQ(rig.lidar0.columns, 2083U);
}

TEST(BoardRig, LetsTheFileComeBeforeTheRecordingsOwnNumbers) {
  Rig rig = parse(kGoodRig).rig;
  complete(rig, {.beams = 64, .columns = 2083, .rate_hz = 10});
  EXPECT_EQ(rig.lidar0.beams, 32U);
  EXPECT_EQ(rig.lidar0.columns, 1024U);
}

}  // namespace
}  // namespace lxd::board_rig_test
