// SPDX-License-Identifier: Apache-2.0
// What a scenario may say of a simulated LiDAR, and which faults it has.
#include <gtest/gtest.h>

#include "tools/simulator/lidar/lidar_faults.hpp"
#include "tools/simulator/lidar/livox_config.hpp"
#include "tools/simulator/lidar/ouster_config.hpp"

namespace lxd::test::simulator_lidar_config_test {
namespace {

using namespace sim;

template <typename Config>
std::string problems_of(const std::string& text, Config& config) {
  Problems problems;
  const YAML::Node node = YAML::Load(text);
  YamlSection section(node, "lidar0", "a.yaml", problems);
  read_keys(section, config);
  section.reject_unknown();
  return text_of(problems);
}

TEST(SimulatedLidarConfig, KeysOfAnOusterAreRead) {
  OusterConfig config;
  const std::string text =
      "{product: OS0, beams: 128, columns: 512, rate_hz: 20, profile: RNG15_RFL8_NIR8, clock_source: "
      "TIME_FROM_PTP_1588,"
      " imu: ACCEL32_GYRO32_NMEA, imu_error_scale: 2, lidar_port: 8000, imu_port: 8001, range_sigma_m: 0.02}";
  EXPECT_EQ(problems_of(text, config), "");
  EXPECT_EQ(config.beams, 128U);
  EXPECT_EQ(config.rate_hz, 20);
  EXPECT_FALSE(config.own_epoch());
  EXPECT_EQ(config.returns.range_max_m, 75);  // the product's
  EXPECT_EQ(config.returns.range_sigma_m, 0.02);
}

TEST(SimulatedLidarConfig, EveryProblemIsToldAtOnce) {
  OusterConfig config;
  const std::string told = problems_of(
      "{product: OS9, beams: 48, columns: 2048, rate_hz: 20, profile: LEGACY, imu: ACCEL32_GYRO32_NMEA,"
      " mixed_part: 25, range_min_m: 200, colour: red}",
      config);
  for (const char* const part :
       {"lidar0.product", "lidar0.beams", "2048x20", "lidar0.imu", "percent", "lidar0.range_max_m", "lidar0.colour"}) {
    EXPECT_NE(told.find(part), std::string::npos) << part << " in\n" << told;
  }
}

TEST(SimulatedLidarConfig, KeysOfALivoxAreRead) {
  LivoxConfig config;
  EXPECT_EQ(problems_of("{clock_source: GPS, imu: false, detection_range_m: 30}", config), "");
  EXPECT_FALSE(config.imu);
  EXPECT_EQ(config.returns.detection_range_m, 30);
  EXPECT_EQ(config.returns.range_max_m, 70);
  EXPECT_NE(problems_of("{clock_source: NTP}", config).find("lidar0.clock_source"), std::string::npos);
}

TEST(SimulatedLidarConfig, FaultsAreNamedAfterTheSensor) {
  EXPECT_EQ(known_lidar_faults("lidar0").size(), static_cast<std::size_t>(LidarFault::kCount));
  EXPECT_EQ(known_lidar_faults("lidar1")[3].name, "lidar1_off");
  EXPECT_TRUE(known_lidar_faults("camera0").empty());
}

TEST(SimulatedLidarConfig, ClockErrorsAddUpAndASkewsOffsetStays) {
  const FaultPlan plan({{"lidar0_skew", 10, 20, 100}, {"lidar0_time_step", 15, 30, -1}, {"lidar1_skew", 0, 99, 500}});
  const LidarFaults faults(plan, "lidar0");
  EXPECT_EQ(faults.clock_error_s(10), 0);
  EXPECT_NEAR(faults.clock_error_s(14), 400e-6, 1e-12);
  EXPECT_NEAR(faults.clock_error_s(25), -1 + 1e-3, 1e-12);
  EXPECT_NEAR(faults.clock_error_s(40), 1e-3, 1e-12);
}

TEST(SimulatedLidarConfig, BootsAreCountedWhenTheyAreOver) {
  const FaultPlan plan({{"lidar0_restart", 10, 11, 0}, {"lidar0_restart", 20, 22, 0}});
  const LidarFaults faults(plan, "lidar0");
  EXPECT_EQ(faults.boot(10.5).number, 0U);
  EXPECT_EQ(faults.boot(11).number, 1U);
  EXPECT_EQ(faults.boot(30).number, 2U);
  EXPECT_EQ(faults.boot(30).down_s, 20);
  EXPECT_TRUE(faults.silent(21));
}

}  // namespace
}  // namespace lxd::test::simulator_lidar_config_test
