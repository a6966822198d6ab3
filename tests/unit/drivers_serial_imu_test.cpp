// SPDX-License-Identifier: Apache-2.0
// What every parser of a serial IMU owes, whatever the protocol: golden bytes, cut and damaged frames, streams in any
// pieces, no allocation.
#include <gtest/gtest.h>

#include "drivers/imu/mip_parser.hpp"
#include "drivers/imu/standard_gravity.hpp"
#include "drivers/imu/vectornav_ascii_parser.hpp"
#include "drivers/imu/xsens_parser.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/serial_stream.hpp"
#include "tools/simulator/imu/imu_encoder.hpp"
#include "tools/simulator/imu/vectornav_ascii_encoder.hpp"

namespace lxd::drivers_serial_imu_test {
namespace {

using sim::Inertial;
using test::Bytes;

constexpr double kBaud = 115200;

// Golden frames are those of the protocol notes, made by other programs; `resolution` is that of the number format.
struct MicroStrain {
  using Parser = MipParser;
  static constexpr ImuProtocol kProtocol = ImuProtocol::kMicroStrain;
  static constexpr std::size_t kLongest = kMipMaxPacketBytes;
  static constexpr std::uint8_t kBegin = kMipSync[0];
  static constexpr double kResolution = 1e-6;
  static Bytes golden() {
    return test::bytes_of_hex("7565801c0e040000000000000000bf8000000e053dcccccd3e4ccccd3e99999aa917");
  }
  static Inertial sample() { return {{0.1, 0.2, 0.3}, {0, 0, -kStandardGravity_mps2}}; }
};
struct Xsens {
  using Parser = XsensParser;
  static constexpr ImuProtocol kProtocol = ImuProtocol::kXsens;
  static constexpr std::size_t kLongest = kXsensMaxFrameBytes;
  static constexpr std::uint8_t kBegin = kXsensSync;
  static constexpr double kResolution = 1e-6;
  static Bytes golden() {
    return test::bytes_of_hex(
        "faff362a10200200071060040001e24040200c0000000000000000411cf5c380200c3dcccccd3e4ccccd3e99999ad5");
  }
  static Inertial sample() { return {{0.1, 0.2, 0.3}, {0, 0, 9.81}}; }
};
struct VectorNavAscii {
  using Parser = VectorNavAsciiParser;
  static constexpr ImuProtocol kProtocol = ImuProtocol::kVectorNavAscii;
  static constexpr std::size_t kLongest = kVectorNavLineMax;
  static constexpr std::uint8_t kBegin = '$';
  static constexpr double kResolution = 5e-4;
  static Bytes golden() {
    return sim::vectornav_line(
        "VNIMU,-00.1000,-00.2000,+00.3000,-00.123,+00.456,-09.789,+00.100000,-00.200000,+00.300000,+22.3,+101.325");
  }
  static Inertial sample() { return {{0.1, -0.2, 0.3}, {-0.123, 0.456, -9.789}}; }
};

template <typename Protocol>
class SerialImu : public testing::Test {
 protected:
  using Parser = typename Protocol::Parser;
  static void expect_sample(const ImuSample& sample, const Inertial& wanted = Protocol::sample()) {
    EXPECT_LT((sample.gyro_radps - wanted.gyro_radps).cwiseAbs().maxCoeff(), Protocol::kResolution);
    EXPECT_LT((sample.accel_mps2 - wanted.accel_mps2).cwiseAbs().maxCoeff(), Protocol::kResolution);
  }
};
using Protocols = testing::Types<MicroStrain, Xsens, VectorNavAscii>;
TYPED_TEST_SUITE(SerialImu, Protocols);

TYPED_TEST(SerialImu, GoldenBytesAreRead) {
  typename TypeParam::Parser parser(kBaud);
  const Bytes golden = TypeParam::golden();
  const auto samples = test::samples_of(parser, golden);
  ASSERT_EQ(samples.size(), 1U);
  this->expect_sample(samples[0]);
  EXPECT_EQ(parser.counts().bytes_accepted, golden.size());
  EXPECT_EQ(parser.counts().frames, 1U);
}

TYPED_TEST(SerialImu, WhatTheSimulatorWritesReadsBack) {
  const Bytes frame = sim::encode_sample(TypeParam::kProtocol, 7, 12'345'600'000, TypeParam::sample());
  EXPECT_EQ(frame.size(), sim::bytes_per_sample(TypeParam::kProtocol));
  typename TypeParam::Parser parser(kBaud);
  const auto samples = test::samples_of(parser, frame);
  ASSERT_EQ(samples.size(), 1U);
  this->expect_sample(samples[0]);
  if (TypeParam::kProtocol != ImuProtocol::kVectorNavAscii) {
    EXPECT_EQ(samples[0].sensor_ns, 12'345'600'000);
  }
}

TYPED_TEST(SerialImu, ATruncatedFrameWaitsForItsRest) {
  const Bytes golden = TypeParam::golden();
  for (std::size_t length = 0; length < golden.size(); ++length) {
    typename TypeParam::Parser parser(kBaud);
    EXPECT_TRUE(test::samples_of(parser, std::span(golden).first(length)).empty()) << length;
    EXPECT_EQ(parser.bytes_pending(), length);
    EXPECT_EQ(test::samples_of(parser, std::span(golden).subspan(length)).size(), 1U) << length;
  }
}

// Given a frame with one wrong bit and good ones behind it, then the good ones are read, and nothing else is.
TYPED_TEST(SerialImu, AnySingleWrongBitIsRefused) {
  constexpr std::size_t kGood = 30;
  const Bytes golden = TypeParam::golden();
  for (std::size_t bit = 0; bit < 8 * golden.size(); ++bit) {
    Bytes stream = golden;
    stream[bit / 8] = static_cast<std::uint8_t>(stream[bit / 8] ^ 1U << bit % 8);
    for (std::size_t i = 0; i < kGood; ++i) test::append(stream, golden);
    stream.resize(stream.size() + TypeParam::kLongest);
    typename TypeParam::Parser parser(kBaud);
    const auto samples = test::samples_of(parser, stream);
    EXPECT_EQ(samples.size(), kGood) << "bit " << bit;
    for (const ImuSample& sample : samples) this->expect_sample(sample);
    EXPECT_TRUE(test::accounts_for(parser, stream.size()));
    EXPECT_GE(parser.counts().bytes_skipped, golden.size());
  }
}

TYPED_TEST(SerialImu, PiecesOfAnySizeGiveTheSameSamples) {
  std::mt19937 random(5);
  Bytes stream;
  constexpr std::size_t kFrames = 150;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const Inertial sample{{0.001 * static_cast<double>(i), 0, 0}, {0, 0, 9}};
    test::append(stream, sim::encode_sample(TypeParam::kProtocol, i, 1'000'000 * static_cast<std::int64_t>(i), sample));
    for (std::size_t k = random() % 20; k > 0; --k)  // noise with many begins of frames in it
      stream.push_back(static_cast<std::uint8_t>(random() % 3 == 0 ? TypeParam::kBegin : random()));
  }
  stream.resize(stream.size() + TypeParam::kLongest);
  for (const unsigned seed : {1U, 2U}) {
    for (const std::size_t longest : {1U, 7U, 62U, 5000U}) {
      typename TypeParam::Parser parser(kBaud);
      const auto samples = test::samples_in_pieces(parser, stream, longest, seed);
      ASSERT_EQ(samples.size(), kFrames) << longest;
      for (std::size_t i = 0; i < kFrames; ++i)
        this->expect_sample(samples[i], {{0.001 * static_cast<double>(i), 0, 0}, {0, 0, 9}});
      EXPECT_TRUE(test::accounts_for(parser, stream.size()));
    }
  }
}

// Two frames in one piece: each can have been sent no later than its place on the line allows.
TYPED_TEST(SerialImu, TimesByArrivalGoBackByTheBytesOnTheLine) {
  const Bytes golden = TypeParam::golden();
  Bytes two = golden;
  test::append(two, golden);
  typename TypeParam::Parser parser(100'000);  // 100 us a byte
  const RigTime received = RigTime::from_seconds(10);
  const auto samples = test::samples_of(parser, two, received);
  ASSERT_EQ(samples.size(), 2U);
  const auto bytes = static_cast<std::int64_t>(golden.size());
  EXPECT_EQ((received - samples[0].t).ns(), 2 * bytes * 100'000);
  EXPECT_EQ((received - samples[1].t).ns(), bytes * 100'000);
  EXPECT_EQ(samples[0].received, received);
}

TYPED_TEST(SerialImu, AllocatesNothing) {
  const Bytes golden = TypeParam::golden();
  typename TypeParam::Parser parser(kBaud);
  ImuSample sample;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    parser.feed(golden, {});
    EXPECT_TRUE(parser.next(sample));
    EXPECT_FALSE(parser.next(sample));
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace lxd::drivers_serial_imu_test
