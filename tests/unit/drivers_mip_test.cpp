// SPDX-License-Identifier: Apache-2.0
// What only a MicroStrain has: fields in any order, three sorts of time, and what of them is refused.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "drivers/imu/big_endian.hpp"
#include "drivers/imu/mip_parser.hpp"
#include "tests/support/serial_stream.hpp"
#include "tools/simulator/imu/mip_encoder.hpp"

namespace lxd::drivers_mip_test {
namespace {

using sim::encode_mip_packet;
using test::Bytes;

constexpr double kBaud = 115200;
const sim::Inertial kSample{{0.1, 0.2, 0.3}, {0, 0, -9.8}};

Bytes gps_time(const MipField& field, double of_week_s, std::uint16_t week, std::uint16_t flags) {
  Bytes bytes(kMipFieldHeaderBytes + field.data_bytes);
  bytes[0] = static_cast<std::uint8_t>(bytes.size());
  bytes[1] = field.descriptor;
  std::uint8_t* const at = &bytes[kMipFieldHeaderBytes];
  put_big_endian(at, 8, std::bit_cast<std::uint64_t>(of_week_s));
  put_big_endian(at + mip::kWeekAt, 2, week);
  put_big_endian(at + mip::kFlagsAt, 2, flags);
  return bytes;
}

std::optional<std::int64_t> time_with(const Bytes& time_field) {
  Bytes payload = time_field;
  test::append(payload, sim::mip_inertial_fields(kSample));
  MipParser parser(kBaud);
  const auto samples = test::samples_of(parser, encode_mip_packet(kMipImuSet, payload));
  EXPECT_EQ(samples.size(), 1U);
  return samples.empty() ? std::nullopt : samples[0].sensor_ns;
}

TEST(Mip, TheProtocolsPingIsSoundAndNoSample) {
  const Bytes ping = test::bytes_of_hex("756501020201e0c6");
  EXPECT_EQ(encode_mip_packet(0x01, Bytes{0x02, 0x01}), ping);
  MipParser parser(kBaud);
  EXPECT_TRUE(test::samples_of(parser, ping).empty());
  EXPECT_EQ(parser.counts().frames, 1U);
  EXPECT_EQ(parser.counts().no_imu_fields, 1U);
  EXPECT_EQ(parser.counts().bytes_skipped, 0U);
}

TEST(Mip, TimeIsTheDevicesOwnElseGps) {
  EXPECT_EQ(time_with({}), std::nullopt);
  EXPECT_EQ(time_with(sim::mip_reference_time(1'234'567'890'123)), 1'234'567'890'123);
  EXPECT_EQ(time_with(gps_time(mip::kSharedGpsTime, 2.5, 2, 0x03)), 1'209'602'500'000'000);
  EXPECT_EQ(time_with(gps_time(mip::kGpsTime, 2.5, 2, 0x18)), 1'209'602'500'000'000);
  Bytes both = gps_time(mip::kGpsTime, 2.5, 2, 0x18);
  test::append(both, sim::mip_reference_time(5));
  EXPECT_EQ(time_with(both), 5);
}

TEST(Mip, GpsTimeThatTheDeviceDoesNotKnowIsNone) {
  EXPECT_EQ(time_with(gps_time(mip::kSharedGpsTime, 2.5, 2, 0x02)), std::nullopt);
  EXPECT_EQ(time_with(gps_time(mip::kGpsTime, 2.5, 2, 0x17)), std::nullopt);
  EXPECT_EQ(time_with(gps_time(mip::kGpsTime, 700'000, 2, 0x18)), std::nullopt);
  EXPECT_EQ(time_with(gps_time(mip::kGpsTime, -1, 2, 0x18)), std::nullopt);
  EXPECT_EQ(time_with(gps_time(mip::kGpsTime, std::nan(""), 2, 0x18)), std::nullopt);
  EXPECT_EQ(time_with(gps_time(mip::kGpsTime, 2.5, 0xFFFF, 0x18)), std::nullopt);
}

TEST(Mip, UnknownFieldsArePassedOver) {
  Bytes payload{0x06, 0x77, 1, 2, 3, 4, 0x02, 0x78};
  test::append(payload, sim::mip_inertial_fields(kSample));
  MipParser parser(kBaud);
  EXPECT_EQ(test::samples_of(parser, encode_mip_packet(kMipImuSet, payload)).size(), 1U);
}

// A payload of sound sum whose fields do not hold together is no sample and costs the packet alone.
TEST(Mip, FieldsThatDoNotHoldTogetherAreCounted) {
  const Bytes sound = sim::mip_inertial_fields(kSample);
  for (const Bytes& payload : {Bytes{0x01}, Bytes{0x00, 0x04}, Bytes{0x05, 0x04, 0, 0}, Bytes{0x04, 0x04, 0, 0},
                               Bytes{0x0F, 0x05, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, Bytes{0x03, 0xD5, 0}}) {
    Bytes all = sound;
    test::append(all, payload);
    MipParser parser(kBaud);
    Bytes stream = encode_mip_packet(kMipImuSet, all);
    test::append(stream, encode_mip_packet(kMipImuSet, sound));
    EXPECT_EQ(test::samples_of(parser, stream).size(), 1U);
    EXPECT_EQ(parser.counts().bad_field, 1U);
    EXPECT_EQ(parser.counts().bytes_skipped, 0U);
  }
}

TEST(Mip, SoundPacketsWithoutASampleAreCounted) {
  MipParser parser(kBaud);
  const Bytes fields = sim::mip_inertial_fields(kSample);
  const Bytes accel_only(fields.begin(), fields.begin() + 14);
  EXPECT_TRUE(test::samples_of(parser, encode_mip_packet(kMipImuSet, accel_only)).empty());
  EXPECT_TRUE(test::samples_of(parser, encode_mip_packet(0x82, fields)).empty());  // the filter's, not the IMU's
  EXPECT_EQ(parser.counts().no_imu_fields, 2U);
  sim::Inertial broken = kSample;
  broken.gyro_radps.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(test::samples_of(parser, sim::encode_mip(1, broken)).empty());
  EXPECT_EQ(parser.counts().non_finite, 1U);
}

TEST(Mip, APacketInsideADamagedOneIsFound) {
  const Bytes inner = sim::encode_mip(9, kSample);
  Bytes outer{kMipSync[0], kMipSync[1], kMipImuSet, 0x80};
  test::append(outer, inner);
  outer.resize(4 + 0x80 + 2);
  MipParser parser(kBaud);
  EXPECT_EQ(test::samples_of(parser, outer).size(), 1U);
  EXPECT_EQ(parser.counts().bad_checksum, 1U);
  EXPECT_TRUE(test::accounts_for(parser, outer.size()));
}

}  // namespace
}  // namespace lxd::drivers_mip_test
