// SPDX-License-Identifier: Apache-2.0
// The VectorNav parser against frames from elsewhere, its encoder, and damage.
#include <algorithm>

#include <gtest/gtest.h>

#include "drivers/imu/crc16.hpp"
#include "drivers/imu/vectornav_parser.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/serial_stream.hpp"
#include "tools/simulator/imu/vectornav_encoder.hpp"

namespace lxd::drivers_vectornav_test {
namespace {

using sim::encode_vectornav;
using sim::Inertial;
using test::Bytes;

constexpr double kBaud = 115200;
// Start-up time 1 s; acceleration (0, 0, -9.81) m/s^2; rate (0.1, 0.2, 0.3) rad/s.
constexpr const char* kGolden = "fa01010200ca9a3b000000000000000000000000c3f51cc1cdcccc3dcdcc4c3e9a99993e72cc";
const Inertial kGoldenSample{{0.1, 0.2, 0.3}, {0, 0, -9.81}};
constexpr std::int64_t kGoldenTime_ns = 1'000'000'000;

void expect_golden(const ImuSample& sample) {
  EXPECT_EQ(sample.sensor_ns, kGoldenTime_ns);
  EXPECT_LT((sample.gyro_radps - kGoldenSample.gyro_radps).norm(), 1e-7);
  EXPECT_LT((sample.accel_mps2 - kGoldenSample.accel_mps2).norm(), 1e-6);
}

VectorNavLayout layout_of(std::initializer_list<VectorNavField> fields) {
  VectorNavLayout layout;
  for (const VectorNavField field : fields) layout.add(field);
  return layout;
}

Bytes sealed(Bytes frame) {
  const unsigned crc = crc16(std::span(frame).subspan(1));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8U));
  frame.push_back(static_cast<std::uint8_t>(crc));
  return frame;
}

TEST(VectorNavCrc, ChecksTheCataloguesValue) {
  const Bytes digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc16(digits), 0x31C3);
}

TEST(VectorNavGolden, IsReadAndWritten) {
  VectorNavParser parser(kBaud);
  const Bytes golden = test::bytes_of_hex(kGolden);
  const auto samples = test::samples_of(parser, golden);
  ASSERT_EQ(samples.size(), 1U);
  expect_golden(samples[0]);
  EXPECT_EQ(parser.counts().bytes_accepted, golden.size());
  EXPECT_EQ(encode_vectornav(sim::vectornav_layout(), kGoldenTime_ns, kGoldenSample), golden);
}

// ArduPilot's output of a VN-100, `$VNWRG,75,3,<div>,14,073E,0004`, is 104 bytes long; of a VN-300 there are longer
// ones.
TEST(VectorNavFormat, ArduPilotsFramesHaveTheirLength) {
  VectorNavLayout layout;
  layout.groups = 0x14;
  layout.fields[2] = 0x073E;
  layout.fields[4] = 0x0004;
  EXPECT_EQ(layout.frame_bytes(), 104U);
  VectorNavParser parser(kBaud);
  const auto samples = test::samples_of(parser, encode_vectornav(layout, 5, kGoldenSample));
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].sensor_ns, std::nullopt);
  EXPECT_LT((samples[0].gyro_radps - kGoldenSample.gyro_radps).norm(), 1e-7);
}

// Given any one field of the table beside time and sample, then those are still found.
TEST(VectorNavFormat, EveryKnownFieldIsPassedOver) {
  for (std::uint8_t group = 0; group < kVectorNavGroups; ++group) {
    for (std::uint8_t bit = 0; bit < 16; ++bit) {
      if (kVectorNavFieldBytes[group][bit] == 0) continue;
      const VectorNavLayout layout = layout_of({vectornav::kTimeStartup, vectornav::kImu, {group, bit}});
      VectorNavParser parser(kBaud);
      const auto samples = test::samples_of(parser, encode_vectornav(layout, kGoldenTime_ns, kGoldenSample));
      ASSERT_EQ(samples.size(), 1U) << int{group} << "." << int{bit};
      expect_golden(samples[0]);
    }
  }
}

TEST(VectorNavFormat, RateAndAccelerationAreTakenFromWhereverTheyAre) {
  namespace v = vectornav;
  for (const VectorNavLayout& layout :
       {layout_of({v::kTimeGps, v::kAngularRate, v::kAccel}),
        layout_of({v::kTimeGroupStartup, v::kImuGroupUncompAccel, v::kImuGroupUncompGyro}),
        layout_of({v::kTimeGroupGps, v::kImuGroupAccel, v::kImuGroupAngularRate})}) {
    VectorNavParser parser(kBaud);
    const auto samples = test::samples_of(parser, encode_vectornav(layout, kGoldenTime_ns, kGoldenSample));
    ASSERT_EQ(samples.size(), 1U);
    expect_golden(samples[0]);
  }
}

TEST(VectorNavParser, ATruncatedFrameWaitsForItsRest) {
  const Bytes golden = test::bytes_of_hex(kGolden);
  for (std::size_t length = 0; length < golden.size(); ++length) {
    VectorNavParser parser(kBaud);
    EXPECT_TRUE(test::samples_of(parser, std::span(golden).first(length)).empty()) << length;
    EXPECT_EQ(parser.bytes_pending(), length);
    EXPECT_EQ(test::samples_of(parser, std::span(golden).subspan(length)).size(), 1U) << length;
  }
}

// Given a frame with one wrong bit and good ones behind it, then the good ones are read, and nothing else is.
TEST(VectorNavParser, AnySingleWrongBitIsRefused) {
  constexpr std::size_t kGood = 20;
  const Bytes golden = test::bytes_of_hex(kGolden);
  for (std::size_t bit = 0; bit < 8 * golden.size(); ++bit) {
    Bytes stream = golden;
    stream[bit / 8] = static_cast<std::uint8_t>(stream[bit / 8] ^ 1U << bit % 8);
    for (std::size_t i = 0; i < kGood; ++i) test::append(stream, golden);
    stream.resize(stream.size() + kVectorNavMaxFrameBytes);
    VectorNavParser parser(kBaud);
    const auto samples = test::samples_of(parser, stream);
    EXPECT_EQ(samples.size(), kGood) << "bit " << bit;
    for (const ImuSample& sample : samples) expect_golden(sample);
    EXPECT_TRUE(test::accounts_for(parser, stream.size()));
    EXPECT_GE(parser.counts().bytes_skipped, golden.size());
  }
}

TEST(VectorNavParser, PiecesOfAnySizeGiveTheSameSamples) {
  std::mt19937 random(5);
  Bytes stream;
  constexpr std::int64_t kFrames = 200;
  for (std::int64_t i = 0; i < kFrames; ++i) {
    test::append(stream, encode_vectornav(sim::vectornav_layout(), i, kGoldenSample));
    for (std::size_t k = random() % 20; k > 0; --k)  // noise with many begins of frames in it
      stream.push_back(static_cast<std::uint8_t>(random() % 3 == 0 ? kVectorNavSync : random()));
  }
  stream.resize(stream.size() + kVectorNavMaxFrameBytes);
  for (const unsigned seed : {1U, 2U, 3U}) {
    for (const std::size_t longest : {1U, 7U, 62U, 5000U}) {
      VectorNavParser parser(kBaud);
      const auto samples = test::samples_in_pieces(parser, stream, longest, seed);
      ASSERT_EQ(samples.size(), kFrames) << longest;
      for (std::int64_t i = 0; i < kFrames; ++i) EXPECT_EQ(samples[i].sensor_ns, i);
      EXPECT_TRUE(test::accounts_for(parser, stream.size()));
    }
  }
}

TEST(VectorNavParser, AFrameLongerThanTheBoundIsRefusedByItsHeader) {
  Bytes frame{kVectorNavSync, 0x7F};
  for (std::size_t group = 0; group < kVectorNavGroups; ++group) test::append(frame, {0xFF, 0x03});
  VectorNavParser parser(kBaud);
  EXPECT_TRUE(test::samples_of(parser, frame).empty());
  EXPECT_EQ(parser.counts().too_long, 1U);
  EXPECT_EQ(parser.bytes_pending(), 0U);
}

TEST(VectorNavParser, AFieldWithoutKnownLengthIsRefusedByItsHeader) {
  for (const Bytes& header : {Bytes{kVectorNavSync, 0x80}, Bytes{kVectorNavSync, 0x01, 0x00, 0x80},
                              Bytes{kVectorNavSync, 0x08, 0x00, 0x40}, Bytes{kVectorNavSync, 0x00}}) {
    VectorNavParser parser(kBaud);
    EXPECT_TRUE(test::samples_of(parser, header).empty());
    EXPECT_EQ(parser.counts().unknown_field, 1U);
    EXPECT_EQ(parser.bytes_pending(), 0U);
  }
}

TEST(VectorNavParser, SoundFramesWithoutASampleAreCounted) {
  VectorNavParser parser(kBaud);
  const Bytes times_only = encode_vectornav(layout_of({vectornav::kTimeStartup, vectornav::kAccel}), 1, {});
  EXPECT_TRUE(test::samples_of(parser, times_only).empty());
  EXPECT_EQ(parser.counts().no_imu_fields, 1U);

  Inertial broken = kGoldenSample;
  broken.gyro_radps.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(test::samples_of(parser, encode_vectornav(sim::vectornav_layout(), 1, broken)).empty());
  broken = kGoldenSample;
  broken.accel_mps2.z() = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(test::samples_of(parser, encode_vectornav(sim::vectornav_layout(), 1, broken)).empty());
  EXPECT_EQ(parser.counts().non_finite, 2U);
  EXPECT_EQ(parser.counts().bytes_skipped, 0U);
}

TEST(VectorNavParser, AFrameWithAWrongCrcIsSearchedForOthers) {
  const Bytes header{kVectorNavSync, 0x01, 0x00, 0x08};  // DeltaTheta: 28 bytes
  const Bytes inner = sealed(Bytes{kVectorNavSync, 0x02, 0x08, 0x00, 1, 2});
  Bytes outer(34);
  std::ranges::copy(header, outer.begin());
  std::ranges::copy(inner, outer.begin() + 4);
  VectorNavParser parser(kBaud);
  EXPECT_TRUE(test::samples_of(parser, outer).empty());
  EXPECT_EQ(parser.counts().bad_crc, 1U);
  EXPECT_EQ(parser.counts().frames, 1U);  // the inner one
  EXPECT_TRUE(test::accounts_for(parser, outer.size()));
}

// Two frames in one piece: each can have been sent no later than its place on the line allows.
TEST(VectorNavParser, TimesByArrivalGoBackByTheBytesOnTheLine) {
  const Bytes golden = test::bytes_of_hex(kGolden);
  Bytes two = golden;
  test::append(two, golden);
  VectorNavParser parser(100'000);  // 100 us a byte
  const RigTime received = RigTime::from_seconds(10);
  const auto samples = test::samples_of(parser, two, received);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ((received - samples[0].t).ns(), 76 * 100'000);
  EXPECT_EQ((received - samples[1].t).ns(), 38 * 100'000);
  EXPECT_EQ(samples[0].received, received);
}

// A piece that does not fit at once is fed in parts: the time of its first frames is none the worse.
TEST(VectorNavParser, TimesOfALargePieceCountTheBytesThatWait) {
  Bytes many;
  for (int i = 0; i < 100; ++i) test::append(many, test::bytes_of_hex(kGolden));
  VectorNavParser parser(100'000);
  const RigTime received = RigTime::from_seconds(10);
  const auto samples = test::samples_of(parser, many, received);
  ASSERT_EQ(samples.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ((received - samples[i].t).ns(), (100 - i) * 38 * 100'000) << i;
}

TEST(VectorNavParser, AllocatesNothing) {
  const Bytes bytes = encode_vectornav(sim::vectornav_layout(), kGoldenTime_ns, kGoldenSample);
  VectorNavParser parser(kBaud);
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
}  // namespace lxd::drivers_vectornav_test
