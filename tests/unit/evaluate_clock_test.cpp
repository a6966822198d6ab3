// SPDX-License-Identifier: Apache-2.0
// Errors of clock models: known answers, and the truth's file read or refused line by line.
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/clock_errors.hpp"

namespace lxd::evaluate_clock_test {
namespace {

ClockPair off_by(std::int64_t ns) {
  return {RigTime::from_ns(1'700'000'000'000'000'000), RigTime::from_ns(1'700'000'000'000'000'000 + ns)};
}

TEST(ClockErrorsOf, KnownOffsetsAreExact) {
  const std::vector<ClockPair> pairs{off_by(1000), off_by(-1000), off_by(3000), off_by(1000)};
  const ClockErrors e = clock_errors(pairs);
  EXPECT_EQ(e.samples, 4U);
  EXPECT_NEAR(e.mean_s, 1e-6, 1e-15);
  EXPECT_NEAR(e.rms_s, std::sqrt(3.0) * 1e-6, 1e-12);
  EXPECT_NEAR(e.rms_about_mean_s, std::sqrt(2.0) * 1e-6, 1e-12);
  EXPECT_NEAR(e.max_s, 3e-6, 1e-15);
}

TEST(ClockErrorsOf, TheNinetyNinthOfAHundredIsP99) {
  std::vector<ClockPair> pairs;
  for (int i = 100; i >= 1; --i) pairs.push_back(off_by(-i));
  EXPECT_NEAR(clock_errors(pairs).p99_s, 99e-9, 1e-15);
  EXPECT_NEAR(clock_errors(pairs).max_s, 100e-9, 1e-15);
}

TEST(ClockErrorsOf, NothingIsNoError) { EXPECT_EQ(clock_errors({}).samples, 0U); }

TEST(ClockErrorsOf, TheTableSpeaksMicroseconds) {
  const std::string table = to_table({{"imu", clock_errors(std::vector{off_by(12'300)})}});
  EXPECT_NE(table.find("imu"), std::string::npos);
  EXPECT_NE(table.find("12.3"), std::string::npos);
}

TEST(ClockTruthFile, IsReadBySensor) {
  const test::TemporaryFolder folder;
  test::write_file(
      folder / "clocks.csv",
      "# made by hand\nsensor,rig_ns,sensor_ns\nlidar0,5,1000\nimu,5,-7\r\n\nlidar0,100000005,100001000\n");
  const auto truth = load_clock_truth(folder / "clocks.csv");
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  ASSERT_EQ(truth->at("lidar0").size(), 2U);
  EXPECT_EQ(truth->at("lidar0")[1].rig.ns(), 100'000'005);
  EXPECT_EQ(truth->at("lidar0")[1].sensor_ns, 100'001'000);
  EXPECT_EQ(truth->at("imu")[0].sensor_ns, -7);
}

TEST(ClockTruthFile, DamageIsNamedByFileLineAndCause) {
  const test::TemporaryFolder folder;
  const auto error_of = [&](const std::string& line) {
    test::write_file(folder / "clocks.csv", "imu,0,0\n" + line + "\n");
    const auto truth = load_clock_truth(folder / "clocks.csv");
    return truth.ok() ? "" : truth.error().message;
  };
  EXPECT_NE(error_of("imu,1").find("clocks.csv:2: found 'imu,1'"), std::string::npos);
  EXPECT_NE(error_of("imu,1,2,3").find(":2: found"), std::string::npos);
  EXPECT_NE(error_of(",1,2").find("found ',1,2'"), std::string::npos);
  EXPECT_NE(error_of("imu,one,2").find("'one', wanted whole nanoseconds"), std::string::npos);
  EXPECT_NE(error_of("imu,1,2.5").find("'2.5', wanted whole nanoseconds"), std::string::npos);
  EXPECT_NE(error_of("imu,1,0").find("wanted later"), std::string::npos);
  EXPECT_NE(error_of("imu,-1,5").find("wanted later"), std::string::npos);
  EXPECT_EQ(error_of("imu,1,5"), "");
  EXPECT_NE(load_clock_truth(folder / "no.csv").error().message.find("No such file"), std::string::npos);
}

// A clock that is a day ahead and gains 50 ppm, told once a second: between, before and after, to the nanosecond.
TEST(TrueTime, FollowsAClockThatGains) {
  constexpr std::int64_t kRig_ns = 1'700'000'000'000'000'000, kDay_ns = 86'400'000'000'000;
  const auto sensor_at = [](std::int64_t since_ns) { return kDay_ns + kRig_ns + since_ns + since_ns / 20'000; };
  std::vector<ClockTruth> truth;
  for (std::int64_t second = 0; second < 4; ++second)
    truth.push_back({RigTime::from_ns(kRig_ns + second * kNanosPerSecond), sensor_at(second * kNanosPerSecond)});
  for (const std::int64_t since_ns : {-500'000'000LL, 0LL, 20'000LL, 1'000'000'000LL, 2'340'000'000LL, 3'600'000'000LL})
    EXPECT_NEAR(static_cast<double>(true_time(truth, sensor_at(since_ns)).ns() - kRig_ns - since_ns), 0, 1) << since_ns;
  EXPECT_EQ(true_time(std::span(truth).first(2), sensor_at(100'000)).ns(), kRig_ns + 100'000) << "two are enough";
}

}  // namespace
}  // namespace lxd::evaluate_clock_test
