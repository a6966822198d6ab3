// SPDX-License-Identifier: Apache-2.0
// The IMU of a recording: both of its files say the same, the serial one is preferred, and neither is an error.
#include <gtest/gtest.h>

#include "drivers/replay/imu_source.hpp"
#include "tests/support/simulated_imu.hpp"

namespace lxd::drivers_imu_source_test {
namespace {

using test::SimulatedImu;

std::vector<ImuSample> all_of(ImuSource& source) {
  std::vector<ImuSample> samples;
  for (ImuSample sample; source.next(sample);) samples.push_back(sample);
  return samples;
}

std::unique_ptr<ImuSource> must_open(const SimulatedImu& imu) {
  auto source = open_imu_source(imu.folder.path(), imu.config.protocol, imu.config.line.baud_rate);
  EXPECT_TRUE(source.ok()) << (source.ok() ? "" : source.error().message);
  return source.ok() ? std::move(*source) : nullptr;
}

TEST(ImuSourceTest, BothFilesOfARecordingTellTheSame) {
  const SimulatedImu imu(3);
  (void)imu.write({.serial = true, .generic = true});
  const auto serial = all_of(*must_open(imu));
  std::filesystem::remove(imu.folder / kImuSerialFile);
  const auto text = all_of(*must_open(imu));
  ASSERT_GT(text.size(), 250U);
  ASSERT_NEAR(static_cast<double>(serial.size()), static_cast<double>(text.size()), 3);
  // Each sample of the line has its text within what a clock model and the wire's digits leave.
  std::size_t at = 0, met = 0;
  for (const ImuSample& sample : serial) {
    while (at + 1 < text.size() && text[at + 1].t <= sample.t + Duration::from_ns(2'000'000)) ++at;
    const bool near = std::abs((text[at].t - sample.t).seconds()) < 2.5e-3;
    met += near && (text[at].gyro_radps - sample.gyro_radps).norm() < 1e-3 &&
           (text[at].accel_mps2 - sample.accel_mps2).norm() < 1e-2;
  }
  EXPECT_GT(met, 95 * serial.size() / 100);
}

TEST(ImuSourceTest, TimesAreThoseOfTheRigAndAscend) {
  const SimulatedImu imu(3);
  (void)imu.write();
  RigTime last;
  for (const ImuSample& sample : all_of(*must_open(imu))) {
    EXPECT_GT(sample.t, last);
    last = sample.t;
  }
  EXPECT_NEAR((last - imu.context().start).seconds(), 3, 0.05);
}

TEST(ImuSourceTest, ATextsSamplesAreWhatItsLinesSay) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "imu.csv", "t,gx,gy,gz,ax,ay,az\r\n1.25,1,2,3,4,5,6\r\nbad\r\n1.26,7,8,9,10,11,12\r\n");
  auto source = open_imu_source(folder.path(), ImuProtocol::kVectorNav, 115'200);
  ASSERT_TRUE(source.ok());
  const auto samples = all_of(**source);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].t, RigTime::from_ns(1'250'000'000));
  EXPECT_EQ(samples[1].gyro_radps, Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(samples[1].accel_mps2, Eigen::Vector3d(10, 11, 12));
  EXPECT_FALSE(samples[0].sensor_ns);
  EXPECT_EQ((*source)->rejected(), (Rejections{{"bad_line", 1}}));
}

TEST(ImuSourceTest, AFolderWithoutEitherIsAnErrorThatNamesBoth) {
  const test::TemporaryFolder folder;
  const auto source = open_imu_source(folder.path(), ImuProtocol::kVectorNav, 115'200);
  ASSERT_FALSE(source.ok());
  for (const char* const name : {"imu.serial", "imu.csv"})
    EXPECT_NE(source.error().message.find(name), std::string::npos) << source.error().message;
}

TEST(ImuSourceTest, DamageOnTheLineIsCountedAndPassedOver) {
  const SimulatedImu imu(3);
  (void)imu.write();
  const std::size_t whole = all_of(*must_open(imu)).size();
  std::string bytes = test::read_file(imu.folder / kImuSerialFile);
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 40; ++i) bytes[i] = static_cast<char>(~bytes[i]);
  test::write_file(imu.folder / kImuSerialFile, bytes);
  const auto source = must_open(imu);
  const std::size_t left = all_of(*source).size();
  EXPECT_LT(left, whole);
  EXPECT_GT(left, whole * 4 / 10);
  EXPECT_FALSE(source->rejected().empty());
}

}  // namespace
}  // namespace lxd::drivers_imu_source_test
