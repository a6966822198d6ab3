// SPDX-License-Identifier: Apache-2.0
// What only an Xsens has: items in any order and two number formats, long messages, a time that wraps.
#include <limits>

#include <gtest/gtest.h>

#include "drivers/imu/big_endian.hpp"
#include "drivers/imu/xsens_parser.hpp"
#include "tests/support/serial_stream.hpp"
#include "tools/simulator/imu/xsens_encoder.hpp"

namespace lxd::drivers_xsens_test {
namespace {

using sim::encode_xsens;
using sim::encode_xsens_message;
using test::Bytes;

constexpr double kBaud = 115200;
const sim::Inertial kSample{{0.1, 0.2, 0.3}, {0, 0, 9.81}};

Bytes item(unsigned id, const Bytes& value) {
  Bytes bytes{static_cast<std::uint8_t>(id >> 8U), static_cast<std::uint8_t>(id),
              static_cast<std::uint8_t>(value.size())};
  for (const std::uint8_t byte : value) bytes.push_back(byte);
  return bytes;
}

Bytes floats(const Eigen::Vector3d& v) {
  Bytes bytes(12);
  put_big_endian_floats(bytes.data(), v);
  return bytes;
}

Bytes doubles(const Eigen::Vector3d& v) {
  Bytes bytes(24);
  for (int i = 0; i < 3; ++i)
    put_big_endian(&bytes[8 * static_cast<std::size_t>(i)], 8, std::bit_cast<std::uint64_t>(v[i]));
  return bytes;
}

Bytes joined(const Bytes& a, const Bytes& b) {
  Bytes all = a;
  test::append(all, b);
  return all;
}

std::vector<ImuSample> samples_of_data(XsensParser& parser, const Bytes& data) {
  return test::samples_of(parser, encode_xsens_message(kXsensData, data));
}

TEST(Xsens, TheGoldenMessageIsWrittenToo) {
  EXPECT_EQ(encode_xsens(7, 12'345'600'000, kSample),
            test::bytes_of_hex(
                "faff362a10200200071060040001e24040200c0000000000000000411cf5c380200c3dcccccd3e4ccccd3e99999ad5"));
}

TEST(Xsens, ItsCommandsAreSoundAndNoSample) {
  for (const char* const command : {"faff3000d1", "faff1000f1"}) {
    XsensParser parser(kBaud);
    EXPECT_TRUE(test::samples_of(parser, test::bytes_of_hex(command)).empty());
    EXPECT_EQ(parser.counts().no_imu_fields, 1U);
    EXPECT_EQ(parser.counts().bytes_skipped, 0U);
  }
}

TEST(Xsens, DoublesAndHighRatesAndOtherItemsAreRead) {
  const Bytes others = joined(item(0x2010, Bytes(16)), item(0xC020, Bytes(12)));
  for (const Bytes& data :
       {joined(item(0x4023, doubles(kSample.accel_mps2)), item(0x8023, doubles(kSample.gyro_radps))),
        joined(item(0x8040, floats(kSample.gyro_radps)), item(0x4040, floats(kSample.accel_mps2))),
        joined(item(0x4024, floats(kSample.accel_mps2)), item(0x8028, floats(kSample.gyro_radps)))}) {
    XsensParser parser(kBaud);
    const auto samples = samples_of_data(parser, joined(others, data));
    ASSERT_EQ(samples.size(), 1U);
    EXPECT_LT((samples[0].gyro_radps - kSample.gyro_radps).norm(), 1e-7);
    EXPECT_LT((samples[0].accel_mps2 - kSample.accel_mps2).norm(), 1e-6);
    EXPECT_EQ(samples[0].sensor_ns, std::nullopt);
  }
}

TEST(Xsens, AMessageWithTheExtendedLengthIsRead) {
  Bytes data = joined(item(0x4020, floats(kSample.accel_mps2)), item(0x8020, floats(kSample.gyro_radps)));
  for (int i = 0; i < 4; ++i) test::append(data, item(0x7010, Bytes(240)));
  XsensParser parser(kBaud);
  EXPECT_EQ(samples_of_data(parser, data).size(), 1U);
  EXPECT_GT(parser.counts().bytes_accepted, 0xFFU);
}

TEST(Xsens, AnImpossibleLengthIsRefusedByItsHeader) {
  XsensParser parser(kBaud);
  EXPECT_TRUE(test::samples_of(parser, Bytes{0xFA, 0xFF, 0x36, 0xFF, 0x04, 0x01}).empty());
  EXPECT_EQ(parser.counts().too_long, 1U);
  EXPECT_EQ(parser.bytes_pending(), 0U);
}

// Given the device's 32 bits running over, then its time goes on; given a restart, then it begins anew.
TEST(Xsens, TimeGoesOnWhereItsCounterWraps) {
  XsensParser parser(kBaud);
  constexpr std::int64_t kTick = xsens::kSampleTick_ns, kWrap = sim::kXsensTimeEnd_ns;
  const auto time_at = [&](std::int64_t sensor_ns) {
    const auto samples = test::samples_of(parser, encode_xsens(0, sensor_ns % kWrap, kSample));
    return samples.empty() ? std::nullopt : samples[0].sensor_ns;
  };
  EXPECT_EQ(time_at(kWrap - 2 * kTick), kWrap - 2 * kTick);
  EXPECT_EQ(time_at(kWrap + 3 * kTick), kWrap + 3 * kTick);
  EXPECT_EQ(time_at(kWrap + 5000 * kTick), kWrap + 5000 * kTick);
  EXPECT_EQ(time_at(0), kWrap);
}

TEST(Xsens, ItemsThatDoNotHoldTogetherAreCounted) {
  for (const Bytes& data : {Bytes{0x40}, Bytes{0x40, 0x20}, Bytes{0x40, 0x20, 12, 0}, item(0x4020, Bytes(11)),
                            item(0x8020, Bytes(24)), item(0x4021, Bytes(12)), item(0x1060, Bytes(2))}) {
    XsensParser parser(kBaud);
    EXPECT_TRUE(samples_of_data(parser, data).empty());
    EXPECT_EQ(parser.counts().bad_field, 1U);
    EXPECT_EQ(parser.counts().bytes_skipped, 0U);
  }
}

TEST(Xsens, SoundMessagesWithoutASampleAreCounted) {
  XsensParser parser(kBaud);
  EXPECT_TRUE(samples_of_data(parser, item(0x4020, floats(kSample.accel_mps2))).empty());
  EXPECT_EQ(parser.counts().no_imu_fields, 1U);
  sim::Inertial broken = kSample;
  broken.accel_mps2.z() = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(test::samples_of(parser, encode_xsens(0, 1, broken)).empty());
  EXPECT_EQ(parser.counts().non_finite, 1U);
}

}  // namespace
}  // namespace lxd::drivers_xsens_test
