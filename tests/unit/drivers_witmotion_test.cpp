// SPDX-License-Identifier: Apache-2.0
// The WitMotion parser against frames from elsewhere, its encoder, and damage.
#include <numbers>

#include <gtest/gtest.h>

#include "drivers/imu/witmotion_parser.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/serial_stream.hpp"
#include "tools/simulator/imu/witmotion_encoder.hpp"

namespace lxd::drivers_witmotion_test {
namespace {

using sim::encode_witmotion;
using sim::encode_witmotion_acceleration;
using sim::encode_witmotion_rate;
using sim::encode_witmotion_time;
using sim::Inertial;
using test::Bytes;

constexpr double kBaud = 115200;
// (0, 0, 1 g), 25.00 degC.
constexpr const char* kGoldenAcceleration = "5551000000000008c4097b";
constexpr std::int64_t kNoon_ns = 1'700'000'000'123'000'000;  // 2023-11-14 22:13:20.123
const Inertial kSample{{0.1, -0.2, 3.0}, {1.0, -2.0, 9.8}};

TEST(WitMotionGolden, AccelerationIsReadAndWritten) {
  const Bytes golden = test::bytes_of_hex(kGoldenAcceleration);
  EXPECT_EQ(encode_witmotion_acceleration({0, 0, kStandardGravity_mps2}, 25), golden);
  Bytes burst = golden;
  test::append(burst, encode_witmotion_rate({0, 0, 0}));
  WitMotionParser parser(kBaud);
  const auto samples = test::samples_of(parser, burst);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_NEAR(samples[0].accel_mps2.z(), kStandardGravity_mps2, 1e-12);
  EXPECT_EQ(samples[0].accel_mps2.head<2>().norm(), 0);
  EXPECT_EQ(samples[0].sensor_ns, std::nullopt);
}

// By the vendor's formula, raw / 32768 * 2000 deg/s: raw 0x4000 is 1000 deg/s.
TEST(WitMotionGolden, RateIsInDegreesASecondOnTheWire) {
  Bytes rate = test::bytes_of_hex(
      "555200400000000000"
      "00");
  rate.push_back(witmotion_checksum(rate));
  Bytes burst = test::bytes_of_hex(kGoldenAcceleration);
  test::append(burst, rate);
  WitMotionParser parser(kBaud);
  const auto samples = test::samples_of(parser, burst);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_NEAR(samples[0].gyro_radps.x(), 1000 * std::numbers::pi / 180, 1e-9);
}

TEST(WitMotionRoundTrip, IsWithinHalfAStepOfTheNumberFormat) {
  WitMotionParser parser(kBaud);
  const auto samples = test::samples_of(parser, encode_witmotion(kNoon_ns, kSample));
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].sensor_ns, kNoon_ns);
  EXPECT_LE((samples[0].gyro_radps - kSample.gyro_radps).cwiseAbs().maxCoeff(), kWitMotionRateUnit_radps / 2);
  EXPECT_LE((samples[0].accel_mps2 - kSample.accel_mps2).cwiseAbs().maxCoeff(), kWitMotionAccelUnit_mps2 / 2);
}

TEST(WitMotionRoundTrip, FullScaleSaturates) {
  WitMotionParser parser(kBaud);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto samples = test::samples_of(parser, encode_witmotion(kNoon_ns, {{1000, -1000, nan}, {1e9, -1e9, nan}}));
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_NEAR(samples[0].gyro_radps.x(), 32767 * kWitMotionRateUnit_radps, 1e-9);
  EXPECT_NEAR(samples[0].gyro_radps.y(), -32768 * kWitMotionRateUnit_radps, 1e-9);
  EXPECT_NEAR(samples[0].accel_mps2.z(), -16 * kStandardGravity_mps2, 1e-9);
}

TEST(WitMotionParser, ATruncatedBurstWaitsForItsRest) {
  const Bytes burst = encode_witmotion(kNoon_ns, kSample);
  for (std::size_t length = 0; length < burst.size(); ++length) {
    WitMotionParser parser(kBaud);
    EXPECT_TRUE(test::samples_of(parser, std::span(burst).first(length)).empty()) << length;
    EXPECT_TRUE(test::accounts_for(parser, length));
    EXPECT_EQ(test::samples_of(parser, std::span(burst).subspan(length)).size(), 1U) << length;
  }
}

// Given a burst with one wrong bit and good ones behind it, then only the good ones give samples; unless the bit made
// the time frame another sound frame, which a sum cannot do with one bit.
TEST(WitMotionParser, AnySingleWrongBitIsRefused) {
  constexpr std::size_t kGood = 4;
  const Bytes burst = encode_witmotion(kNoon_ns, kSample);
  for (std::size_t bit = 0; bit < 8 * burst.size(); ++bit) {
    Bytes stream = burst;
    stream[bit / 8] = static_cast<std::uint8_t>(stream[bit / 8] ^ 1U << bit % 8);
    for (std::size_t i = 0; i < kGood; ++i) test::append(stream, burst);
    stream.resize(stream.size() + kWitMotionFrameBytes);
    WitMotionParser parser(kBaud);
    const auto samples = test::samples_of(parser, stream);
    const bool only_time_lost = bit / 8 < kWitMotionFrameBytes;
    EXPECT_EQ(samples.size(), only_time_lost ? kGood + 1 : kGood) << "bit " << bit;
    for (const ImuSample& sample : samples) EXPECT_NEAR(sample.gyro_radps.z(), 3.0, 2e-3);
    EXPECT_EQ(samples.front().sensor_ns.has_value(), !only_time_lost) << "bit " << bit;
    EXPECT_TRUE(test::accounts_for(parser, stream.size()));
  }
}

TEST(WitMotionParser, PiecesOfAnySizeGiveTheSameSamples) {
  std::mt19937 random(5);
  Bytes stream;
  constexpr std::int64_t kBursts = 100, kMilli = 1'000'000;
  for (std::int64_t i = 0; i < kBursts; ++i) {
    test::append(stream, encode_witmotion(kNoon_ns + i * kMilli, kSample));
    for (std::size_t k = random() % 20; k > 0; --k)
      stream.push_back(static_cast<std::uint8_t>(random() % 3 == 0 ? kWitMotionSync : random() % 0x50));
  }
  stream.resize(stream.size() + kWitMotionFrameBytes);
  for (const unsigned seed : {1U, 2U, 3U}) {
    for (const std::size_t longest : {1U, 7U, 62U, 5000U}) {
      WitMotionParser parser(kBaud);
      const auto samples = test::samples_in_pieces(parser, stream, longest, seed);
      ASSERT_EQ(samples.size(), kBursts) << longest;
      for (std::int64_t i = 0; i < kBursts; ++i) EXPECT_EQ(samples[i].sensor_ns, kNoon_ns + i * kMilli);
      EXPECT_TRUE(test::accounts_for(parser, stream.size()));
    }
  }
}

// Halves of two samples must not make one.
TEST(WitMotionParser, AHalfSampleIsCountedAndDropped) {
  const Bytes accel = encode_witmotion_acceleration({0, 0, 9.8}, 25), rate = encode_witmotion_rate({1, 0, 0});
  WitMotionParser parser(kBaud);
  Bytes stream = rate;          // its acceleration is missing
  test::append(stream, accel);  // its rate is missing
  test::append(stream, accel);  // lost: a byte between the halves
  stream.push_back(0);
  test::append(stream, rate);
  EXPECT_TRUE(test::samples_of(parser, stream).empty());
  EXPECT_EQ(parser.counts().orphan_rate, 2U);
  EXPECT_EQ(parser.counts().orphan_acceleration, 2U);
}

TEST(WitMotionParser, FramesOfOtherKindsArePassedOver) {
  Bytes angles = test::bytes_of_hex(
      "5553000000000000"
      "0000");
  angles.push_back(witmotion_checksum(angles));
  Bytes stream = encode_witmotion(kNoon_ns, kSample);
  test::append(stream, angles);
  test::append(stream, encode_witmotion(kNoon_ns, kSample));
  WitMotionParser parser(kBaud);
  EXPECT_EQ(test::samples_of(parser, stream).size(), 2U);
  EXPECT_EQ(parser.counts().no_imu_fields, 1U);
  EXPECT_EQ(parser.counts().bytes_skipped, 0U);
}

TEST(WitMotionParser, AnIdThatNoModuleSendsIsRefused) {
  Bytes frame = test::bytes_of_hex(
      "5560000000000000"
      "0000");
  frame.push_back(witmotion_checksum(frame));
  WitMotionParser parser(kBaud);
  EXPECT_TRUE(test::samples_of(parser, frame).empty());
  EXPECT_EQ(parser.counts().unknown_id, 1U);
  EXPECT_EQ(parser.counts().frames, 0U);
}

TEST(WitMotionParser, ADateThatIsNoneLeavesTheSampleWithoutTime) {
  Bytes time = encode_witmotion_time(kNoon_ns);
  time[3] = 13;  // month
  time[10] = witmotion_checksum(time);
  Bytes burst = time;
  test::append(burst, encode_witmotion_acceleration({0, 0, 9.8}, 25));
  test::append(burst, encode_witmotion_rate({1, 0, 0}));
  WitMotionParser parser(kBaud);
  const auto samples = test::samples_of(parser, burst);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].sensor_ns, std::nullopt);
  EXPECT_EQ(parser.counts().bad_time, 1U);
}

// The sample's time is when its burst's first byte began to be sent.
TEST(WitMotionParser, TimeByArrivalIsTheBurstsBegin) {
  WitMotionParser parser(10'000);  // 1 ms a byte
  const RigTime received = RigTime::from_seconds(10);
  const auto samples = test::samples_of(parser, encode_witmotion(kNoon_ns, kSample), received);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ((received - samples[0].t).ns(), 33'000'000);
  EXPECT_EQ(samples[0].received, received);
}

TEST(WitMotionParser, AllocatesNothing) {
  const Bytes bytes = encode_witmotion(kNoon_ns, kSample);
  WitMotionParser parser(kBaud);
  ImuSample sample;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    parser.feed(bytes, {});
    EXPECT_TRUE(parser.next(sample));
    EXPECT_FALSE(parser.next(sample));
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace lxd::drivers_witmotion_test
