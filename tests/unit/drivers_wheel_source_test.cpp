// SPDX-License-Identifier: Apache-2.0
// The wheels of a recording: a CAN log through the decoder, or text; the log is preferred, and neither is an error.
#include <gtest/gtest.h>

#include "drivers/replay/wheel_source.hpp"
#include "tests/support/simulated_drive.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/wheel/wheel_writer.hpp"

namespace lxd::drivers_wheel_source_test {
namespace {

const WheelDecoderConfig kAgilex{{}, WheelSource::motion, 0.5};

std::vector<CanMessage> agilex() { return {agilex_messages().begin(), agilex_messages().end()}; }

std::vector<WheelSample> all_of(WheelLogSource& source) {
  std::vector<WheelSample> samples;
  for (WheelSample sample; source.next(sample);) samples.push_back(sample);
  return samples;
}

class WheelSourceTest : public testing::Test {
 protected:
  std::unique_ptr<WheelLogSource> must_open() {
    auto source = open_wheel_source(folder_.path(), agilex(), kAgilex);
    EXPECT_TRUE(source.ok()) << (source.ok() ? "" : source.error().message);
    return source.ok() ? std::move(*source) : nullptr;
  }
  void drive(double seconds) {
    const test::Drive way(seconds);
    sim::WheelConfig config;
    config.protocol = sim::WheelProtocol::agilex;
    config.csv = true;
    ASSERT_TRUE(sim::write_wheel(way.context, config, folder_.path()).ok());
  }
  test::TemporaryFolder folder_;
};

TEST_F(WheelSourceTest, BothFilesOfARecordingTellTheSame) {
  drive(3);
  const auto log = all_of(*must_open());
  std::filesystem::remove(folder_ / kCanLogFile);
  const auto text = all_of(*must_open());
  ASSERT_GT(log.size(), 100U);
  ASSERT_EQ(log.size(), text.size());
  for (std::size_t i = 0; i < log.size(); ++i) {
    EXPECT_NEAR(log[i].speed_mps, text[i].speed_mps, 1e-3) << i;
    EXPECT_NEAR(log[i].yaw_rate_radps, text[i].yaw_rate_radps, 1e-3) << i;
    EXPECT_LT(std::abs((log[i].received - text[i].received).seconds()), 2e-3) << i;
  }
}

TEST_F(WheelSourceTest, ATextsSamplesAreWhatItsLinesSay) {
  test::write_file(folder_ / "wheel.csv", "t,speed,yaw_rate\r\n1.25,0.5,-0.1\r\n1.27,oops,0\r\n1.29,0.6,0\r\n");
  const auto source = must_open();
  const auto samples = all_of(*source);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].received, RigTime::from_ns(1'250'000'000));
  EXPECT_EQ(samples[0].speed_mps, 0.5);
  EXPECT_EQ(samples[0].yaw_rate_radps, -0.1);
  EXPECT_EQ(samples[0].span.ns(), 0);
  EXPECT_EQ(source->rejected(), (Rejections{{"bad_line", 1}}));
}

TEST_F(WheelSourceTest, WhatIsNoFrameOrHasTheWrongLengthIsCountedAndPassedOver) {
  test::write_file(folder_ / "can.log",
                   "(1.000000) can0 221#01F4000000000000\n"
                   "rubbish\n"
                   "(1.020000) can0 221#01F4\n"
                   "(1.040000) can0 7FF#0102\n"
                   "(1.060000) can0 20000080#0000000000000000\n"
                   "(1.080000) can0 221#01F5000000000000\n");
  const auto source = must_open();
  const auto samples = all_of(*source);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_NEAR(samples[0].speed_mps, 0.5, 1e-9);
  EXPECT_NEAR(samples[1].speed_mps, 0.501, 1e-9);
  EXPECT_EQ(source->rejected().at("bad_line"), 1U);
  EXPECT_EQ(source->rejected().at("bad_length"), 1U);
  EXPECT_EQ(source->rejected().at("error_frame"), 1U);
}

TEST_F(WheelSourceTest, AFolderWithoutEitherIsAnErrorThatNamesBoth) {
  const auto source = open_wheel_source(folder_.path(), agilex(), kAgilex);
  ASSERT_FALSE(source.ok());
  for (const char* const name : {"can.log", "wheel.csv"})
    EXPECT_NE(source.error().message.find(name), std::string::npos) << source.error().message;
}

}  // namespace
}  // namespace lxd::drivers_wheel_source_test
