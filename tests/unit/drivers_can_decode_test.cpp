// SPDX-License-Identifier: Apache-2.0
// CAN frames to wheel samples: golden frames, every table both ways, everything that is refused.

#include <gtest/gtest.h>

#include "drivers/wheel/wheel_decoder.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::drivers_can_decode_test {
namespace {

constexpr double kKmh = 1 / 3.6;
constexpr Duration kPeriod = Duration::from_ns(20'000'000);

CanFrame frame_of(std::uint32_t id, const CanData& data, RigTime received = {}) {
  CanFrame frame;
  frame.id = id;
  frame.length = 8;
  frame.data = data;
  frame.received = received;
  return frame;
}

double decoded(const CanMessage& message, std::string_view name, const CanData& data) {
  return find_signal(message, name)->value(data);
}

WheelDecoderConfig toyota() { return {toyota_messages(), WheelSource::rear_wheels, 1.57}; }
WheelDecoderConfig agilex(WheelSource source) { return {agilex_messages(), source, 0.5}; }

// protocols: 40.00 km/h, encoder 0x12, checksum 0x7d.
TEST(CanTable, ToyotaSpeedGolden) {
  const CanData data{0x00, 0x00, 0x00, 0x00, 0x12, 0x0f, 0xa0, 0x7d};
  const CanMessage& speed = *find_message(toyota_messages(), 0x0B4);
  EXPECT_TRUE(checksum_holds(speed, data));
  EXPECT_NEAR(decoded(speed, "SPEED", data), 40 * kKmh, 1e-12);
  EXPECT_EQ(decoded(speed, "ENCODER", data), 0x12);
}

TEST(CanTable, ToyotaWheelsGolden) {
  const CanMessage& wheels = *find_message(toyota_messages(), 0x0AA);
  CanData data{};
  for (const CanSignal& wheel : wheels.signals) wheel.set_value(data, 36 * kKmh);
  EXPECT_EQ(data, (CanData{0x28, 0x7F, 0x28, 0x7F, 0x28, 0x7F, 0x28, 0x7F}));
}

TEST(CanTable, ToyotaYawRateOfARealFrame) {
  const CanMessage& kinematics = *find_message(toyota_messages(), 0x024);
  const CanData data{0x01, 0xFE, 0x01, 0xD5, 0x41, 0xF9, 0x80, 0xBB};
  EXPECT_TRUE(checksum_holds(kinematics, data));
  EXPECT_NEAR(decoded(kinematics, "YAW_RATE", data), (510 * 0.244 - 125) * 3.14159265358979 / 180, 1e-12);
}

TEST(CanTable, AgilexIsBigEndianAndSigned) {
  const CanMessage& motion = *find_message(agilex_messages(), 0x221);
  const CanData data{0xFF, 0x38, 0x01, 0x2C, 0, 0, 0, 0};
  EXPECT_NEAR(decoded(motion, "linear_velocity", data), -0.2, 1e-12);
  EXPECT_NEAR(decoded(motion, "angular_velocity", data), 0.3, 1e-12);
  const CanMessage& odometry = *find_message(agilex_messages(), 0x311);
  const CanData ways{0xFF, 0xFF, 0xFF, 0xFE, 0x00, 0x00, 0x03, 0xE8};
  EXPECT_EQ(find_signal(odometry, "left_wheel")->raw(ways), -2);
  EXPECT_NEAR(decoded(odometry, "right_wheel", ways), 1.0, 1e-12);
}

TEST(CanTable, EverySignalComesBackAndLeavesItsNeighbours) {
  sim::Random random(7, "signals");
  for (const auto table : {agilex_messages(), toyota_messages(), honda_messages(), nissan_messages()}) {
    for (const CanMessage& message : table) {
      for (const CanSignal& signal : message.signals) {
        EXPECT_LE(signal.bytes(), message.length) << signal.name;
        for (int i = 0; i < 100; ++i) {
          CanData data;
          for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random.bits());
          const CanData before = data;
          const auto range = static_cast<std::uint64_t>(signal.raw_max() - signal.raw_min());
          const std::int64_t raw = signal.raw_min() + static_cast<std::int64_t>(random.bits() % (range + 1));
          signal.set_raw(data, raw);
          EXPECT_EQ(signal.raw(data), raw) << signal.name;
          for (const CanSignal& other : message.signals)
            EXPECT_TRUE(&other == &signal || other.raw(data) == other.raw(before)) << other.name;
          signal.set_raw(data, signal.raw(before));
          EXPECT_EQ(data, before);
        }
      }
    }
  }
}

// The DBC convention by a published example of each order: Intel counts up from its start bit, Motorola down.
TEST(CanTable, ByteOrders) {
  const CanData data{0x12, 0x34, 0x56, 0x78, 0x9A, 0, 0, 0};
  CanSignal signal;
  signal.start_bit = 7;
  signal.bits = 16;
  EXPECT_EQ(signal.raw(data), 0x1234);
  signal.start_bit = 3;
  signal.bits = 12;
  EXPECT_EQ(signal.raw(data), 0x234);
  signal.order = CanByteOrder::intel;
  signal.start_bit = 8;
  signal.bits = 16;
  EXPECT_EQ(signal.raw(data), 0x5634);
  signal.start_bit = 12;
  signal.bits = 8;
  EXPECT_EQ(signal.raw(data), 0x63);
}

TEST(CanTable, ValuesBeyondTheFormatBecomeItsLast) {
  const CanSignal& speed = *find_signal(*find_message(agilex_messages(), 0x221), "linear_velocity");
  CanData data{};
  speed.set_value(data, 100);
  EXPECT_NEAR(speed.value(data), 32.767, 1e-9);
  speed.set_value(data, -100);
  EXPECT_NEAR(speed.value(data), -32.768, 1e-9);
}

TEST(WheelDecoder, ToyotaTurnsLeftWhenTheRightWheelIsFaster) {
  const CanMessage& wheels = *find_message(toyota_messages(), 0x0AA);
  CanData data{};
  find_signal(wheels, "WHEEL_SPEED_RR")->set_value(data, 40 * kKmh);
  find_signal(wheels, "WHEEL_SPEED_RL")->set_value(data, 36 * kKmh);
  WheelDecoder decoder(toyota());
  const auto sample = decoder.decode(frame_of(0x0AA, data, RigTime::from_ns(5)));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->received.ns(), 5);
  EXPECT_NEAR(sample->speed_mps, 38 * kKmh, 1e-9);
  EXPECT_NEAR(sample->yaw_rate_radps, 4 * kKmh / 1.57, 1e-9);
}

TEST(WheelDecoder, FaultBitsAreCountedAndBlockTheirWheel) {
  const CanMessage& wheels = *find_message(toyota_messages(), 0x0AA);
  for (const CanSignal& wheel : wheels.signals) {
    CanData data{0x28, 0x7F, 0x28, 0x7F, 0x28, 0x7F, 0x28, 0x7F};
    wheel.set_faulty(data, true);
    WheelDecoder decoder(toyota());
    const bool rear = wheel.role == CanRole::rear_left || wheel.role == CanRole::rear_right;
    EXPECT_EQ(decoder.decode(frame_of(0x0AA, data)).has_value(), !rear);
    EXPECT_EQ(decoder.counts().fault_bit, 1U);
  }
}

TEST(WheelDecoder, WhatIsRefusedIsCounted) {
  WheelDecoder decoder(toyota());
  CanFrame frame = frame_of(0x0B4, {0, 0, 0, 0, 0x12, 0x0f, 0xa0, 0x7d});
  EXPECT_FALSE(decoder.decode(frame));
  EXPECT_EQ(decoder.counts().other_frames, 1U);
  for (std::uint8_t length = 0; length < 8; ++length) {
    frame.length = length;
    EXPECT_FALSE(decoder.decode(frame));
  }
  EXPECT_EQ(decoder.counts().bad_length, 8U);
  frame.length = 8;
  for (unsigned bit = 0; bit < 64; ++bit) {
    CanFrame flipped = frame;
    flipped.data[bit / 8] = static_cast<std::uint8_t>(flipped.data[bit / 8] ^ 1U << (bit % 8));
    EXPECT_FALSE(decoder.decode(flipped));
  }
  EXPECT_EQ(decoder.counts().bad_checksum, 64U);
  frame.kind = CanKind::remote;
  EXPECT_FALSE(decoder.decode(frame));
  EXPECT_EQ(decoder.counts().remote_frames, 1U);
  frame.kind = CanKind::data;
  frame.extended = true;  // the same number, another id
  EXPECT_FALSE(decoder.decode(frame));
  EXPECT_FALSE(decoder.decode(frame_of(0x123, {})));
  EXPECT_EQ(decoder.counts().unknown_id, 2U);
  frame.kind = CanKind::error;
  frame.id = kCanErrorBusOff;
  EXPECT_FALSE(decoder.decode(frame));
  frame.id = kCanErrorRestarted;
  EXPECT_FALSE(decoder.decode(frame));
  EXPECT_EQ(decoder.counts().error_frames, 2U);
  EXPECT_EQ(decoder.counts().bus_off, 1U);
  EXPECT_FALSE(decoder.decode(frame_of(0x0AA, {0x7F, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF})));
  EXPECT_EQ(decoder.counts().out_of_range, 1U);
  EXPECT_EQ(decoder.counts().samples, 0U);
}

TEST(WheelDecoder, AgilexMotionState) {
  WheelDecoder decoder(agilex(WheelSource::motion));
  const auto sample = decoder.decode(frame_of(0x221, {0x05, 0xDC, 0xFF, 0x9C, 0, 0, 0, 0}));
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->speed_mps, 1.5, 1e-12);
  EXPECT_NEAR(sample->yaw_rate_radps, -0.1, 1e-12);
  EXPECT_EQ(sample->span.ns(), 0);
  EXPECT_FALSE(decoder.decode(frame_of(0x311, {})));
}

class OdometerStory : public testing::Test {
 protected:
  std::optional<WheelSample> at(Duration time, std::int64_t left_mm, std::int64_t right_mm) {
    const CanMessage& odometry = *find_message(agilex_messages(), 0x311);
    CanData data{};
    odometry.signals[0].set_raw(data, left_mm);
    odometry.signals[1].set_raw(data, right_mm);
    return decoder_.decode(frame_of(0x311, data, RigTime::from_seconds(1) + time));
  }
  WheelDecoder decoder_{agilex(WheelSource::odometer)};
};

TEST_F(OdometerStory, DifferencesAreSpeeds) {
  EXPECT_FALSE(at({}, 1000, 1000));
  const auto sample = at(kPeriod + Duration::from_ns(3'000'000), 1020, 1030);  // 3 ms late
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->speed_mps, 0.025 / 0.02, 1e-12);
  EXPECT_NEAR(sample->yaw_rate_radps, 0.010 / 0.02 / 0.5, 1e-12);
  EXPECT_EQ(sample->span, kPeriod);
}

TEST_F(OdometerStory, LostFramesLengthenTheSpan) {
  EXPECT_FALSE(at({}, 0, 0));
  const auto sample = at(kPeriod * 3, 60, 60);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->speed_mps, 1, 1e-12);
  EXPECT_EQ(sample->span, kPeriod * 3);
}

TEST_F(OdometerStory, CountsWrapAsInt32) {
  constexpr std::int64_t kLast = 0x7FFFFFFF;
  EXPECT_FALSE(at({}, kLast - 9, -kLast + 8));
  const auto sample = at(kPeriod, -kLast + 9, kLast - 10);  // over the end, forward and back
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->speed_mps, (0.020 - 0.020) / 2, 1e-3);
  EXPECT_NEAR(sample->yaw_rate_radps, -0.040 / 0.02 / 0.5, 0.2);
}

TEST_F(OdometerStory, LongGapsAndJumpsAreNoSpeed) {
  EXPECT_FALSE(at({}, 0, 0));
  EXPECT_FALSE(at(Duration::from_seconds(0.7), 700, 700));
  EXPECT_EQ(decoder_.counts().gaps, 1U);
  EXPECT_FALSE(at(Duration::from_seconds(0.72), 9'000'000, 9'000'000));  // the robot's count begun anew
  EXPECT_EQ(decoder_.counts().out_of_range, 1U);
  EXPECT_TRUE(at(Duration::from_seconds(0.74), 9'000'020, 9'000'020));
  EXPECT_FALSE(at(Duration::from_seconds(0.74), 9'000'020, 9'000'020));  // twice at one time
  EXPECT_EQ(decoder_.counts().gaps, 2U);
}

}  // namespace
}  // namespace lxd::drivers_can_decode_test
