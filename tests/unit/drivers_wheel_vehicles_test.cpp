// SPDX-License-Identifier: Apache-2.0
// Vehicles whose wheels come in other ways: Honda's packed words, Nissan's two messages, every checksum and every
// kinematics.
#include <cmath>

#include <gtest/gtest.h>

#include "drivers/wheel/wheel_decoder.hpp"

namespace lxd::drivers_wheel_vehicles_test {
namespace {

constexpr double kKmh = 1 / 3.6, kTrack_m = 1.5;

CanFrame frame_of(std::uint32_t id, const CanData& data, RigTime received = {}) {
  CanFrame frame;
  frame.id = id;
  frame.length = 8;
  frame.data = data;
  frame.received = received;
  return frame;
}

// 60.00, 61.00, 62.00, 63.00 km/h in 15 bits each, then the checksum: 1 + 13 + 0 of the id.
constexpr CanData kHondaGolden{0x2E, 0xE0, 0x5F, 0x50, 0xC1, 0xC1, 0x89, 0xC0};

CanData honda_golden() {
  CanData data = kHondaGolden;
  set_checksum(*find_message(honda_messages(), 0x1D0), data);
  return data;
}

TEST(HondaTable, FourWordsWithoutGaps) {
  const CanMessage& wheels = *find_message(honda_messages(), 0x1D0);
  const CanValues values = decode_signals(wheels, honda_golden());
  EXPECT_NEAR(values[CanRole::front_left].value(), 60 * kKmh, 1e-9);
  EXPECT_NEAR(values[CanRole::front_right].value(), 61 * kKmh, 1e-9);
  EXPECT_NEAR(values[CanRole::rear_left].value(), 62 * kKmh, 1e-9);
  EXPECT_NEAR(values[CanRole::rear_right].value(), 63 * kKmh, 1e-9);
}

// By hand: of a frame of zeros only the id's 1 + 13 count, and 8 - 14 is 10 in four bits.
TEST(HondaTable, ChecksumIsWhatHalfBytesLeaveOfEight) {
  const CanMessage& wheels = *find_message(honda_messages(), 0x1D0);
  CanData data{};
  set_checksum(wheels, data);
  EXPECT_EQ(data, (CanData{0, 0, 0, 0, 0, 0, 0, 0x0A}));
  data[7] = 0xF0;  // the half byte beside it counts: 8 - 14 - 15
  set_checksum(wheels, data);
  EXPECT_EQ(data[7], 0xFB);
}

TEST(HondaTable, AnySingleWrongBitIsRefused) {
  WheelDecoder decoder({honda_messages(), WheelSource::rear_wheels, kTrack_m});
  const CanData golden = honda_golden();
  ASSERT_TRUE(decoder.decode(frame_of(0x1D0, golden)));
  for (unsigned bit = 0; bit < 64; ++bit) {
    CanData data = golden;
    data[bit / 8] = static_cast<std::uint8_t>(data[bit / 8] ^ 1U << (bit % 8));
    EXPECT_FALSE(decoder.decode(frame_of(0x1D0, data))) << bit;
  }
  EXPECT_EQ(decoder.counts().bad_checksum, 64U);
}

TEST(CanChecksums, SumAndExclusiveOrAreOfTheBytesBefore) {
  CanMessage message{0x10, "", 4, CanChecksum::sum, {}};
  CanData data{0x80, 0x81, 0x02, 0, 0, 0, 0, 0};
  set_checksum(message, data);
  EXPECT_EQ(data[3], 0x03);
  message.checksum = CanChecksum::exclusive_or;
  EXPECT_TRUE(checksum_holds(message, data));  // of these bytes it is the same
  data[0] = 0x90;
  set_checksum(message, data);
  EXPECT_EQ(data[3], 0x13);
  data[3] = 0x12;
  EXPECT_FALSE(checksum_holds(message, data));
}

TEST(NissanTable, RearWheelsAreAMessageOfTheirOwn) {
  WheelDecoder decoder({nissan_messages(), WheelSource::rear_wheels, kTrack_m});
  EXPECT_FALSE(decoder.decode(frame_of(0x284, {0x1F, 0x40, 0x1F, 0x40})));
  EXPECT_EQ(decoder.counts().other_frames, 1U);
  const auto sample = decoder.decode(frame_of(0x285, {0x20, 0x08, 0x1F, 0x40}));  // right 41, left 40 km/h
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->speed_mps, 40.5 * kKmh, 1e-9);
  EXPECT_NEAR(sample->yaw_rate_radps, kKmh / kTrack_m, 1e-9);
}

class FourWheelStory : public testing::Test {
 protected:
  // A car that turns: each wheel's speed is the length of its velocity, fronts steered along it.
  static CanData wheels(std::uint32_t id, double right_mps, double left_mps) {
    CanData data{};
    const CanMessage& message = *find_message(nissan_messages(), id);
    message.signals[0].set_value(data, right_mps);
    message.signals[1].set_value(data, left_mps);
    return data;
  }
  static WheelDecoderConfig config() {
    WheelDecoderConfig config{nissan_messages(), WheelSource::four_wheels, kTrack_m};
    config.wheelbase_m = 2.7;
    return config;
  }
  WheelDecoder decoder_{config()};
};

TEST_F(FourWheelStory, SteeredWheelsMoveSidewaysToo) {
  constexpr double kSpeed_mps = 8, kYaw_radps = 0.5;
  const double right = kSpeed_mps + kYaw_radps * kTrack_m / 2, left = kSpeed_mps - kYaw_radps * kTrack_m / 2;
  const double sideways = kYaw_radps * 2.7;
  EXPECT_FALSE(
      decoder_.decode(frame_of(0x284, wheels(0x284, std::hypot(right, sideways), std::hypot(left, sideways)))));
  const auto sample = decoder_.decode(frame_of(0x285, wheels(0x285, right, left)));
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->speed_mps, kSpeed_mps, 2e-3);  // steps are 1.4 mm/s
  EXPECT_NEAR(sample->yaw_rate_radps, kYaw_radps, 2e-3);
}

// Given front wheels that are not there yet, or no longer, then there is no sample, and that is counted.
TEST_F(FourWheelStory, PartsThatAreMissingOrOldGiveNone) {
  const CanData rear = wheels(0x285, 5, 5), front = wheels(0x284, 5, 5);
  EXPECT_FALSE(decoder_.decode(frame_of(0x285, rear, RigTime::from_seconds(1))));
  EXPECT_EQ(decoder_.counts().missing_part, 1U);
  (void)decoder_.decode(frame_of(0x284, front, RigTime::from_seconds(1.01)));
  EXPECT_TRUE(decoder_.decode(frame_of(0x285, rear, RigTime::from_seconds(1.02))));
  EXPECT_TRUE(decoder_.decode(frame_of(0x285, rear, RigTime::from_seconds(1.10))));
  EXPECT_FALSE(decoder_.decode(frame_of(0x285, rear, RigTime::from_seconds(1.12))));
  EXPECT_EQ(decoder_.counts().missing_part, 2U);
}

// A table as a rig file may have it: speed and steering angle in one frame of 29 bits, low byte first.
class SteeringStory : public testing::Test {
 protected:
  std::array<CanSignal, 2> signals_{
      CanSignal{"", CanRole::speed, 0, 16, CanByteOrder::intel, true, 0.001, 0, CanSignal::kNoFaultBit},
      CanSignal{"", CanRole::steering_angle, 16, 16, CanByteOrder::intel, true, 0.001, 0, CanSignal::kNoFaultBit}};
  std::array<CanMessage, 1> table_{CanMessage{0x18FF0102, "", 8, CanChecksum::none, signals_, true}};

  std::optional<WheelSample> at(double speed_mps, double angle_rad, bool extended = true) {
    CanFrame frame = frame_of(0x18FF0102, {});
    frame.extended = extended;
    signals_[0].set_value(frame.data, speed_mps);
    signals_[1].set_value(frame.data, angle_rad);
    return decoder().decode(frame);
  }
  WheelDecoder& decoder() {
    if (!decoder_) {
      WheelDecoderConfig config{table_, WheelSource::steering};
      config.wheelbase_m = 0.65;
      decoder_.emplace(config);
    }
    return *decoder_;
  }
  std::optional<WheelDecoder> decoder_;
};

TEST_F(SteeringStory, YawRateIsThatOfTheTurn) {
  const auto sample = at(1.5, 0.3);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->speed_mps, 1.5, 1e-12);
  EXPECT_NEAR(sample->yaw_rate_radps, 1.5 * std::tan(0.3) / 0.65, 1e-12);
  EXPECT_LT(at(-1.5, 0.3)->yaw_rate_radps, 0);
}

TEST_F(SteeringStory, AngleOfAWheelThatStandsAcrossIsOutOfRange) {
  EXPECT_FALSE(at(1.5, 1.57));
  EXPECT_EQ(decoder().counts().out_of_range, 1U);
}

TEST_F(SteeringStory, IdsOf11And29BitsAreNotTheSame) {
  EXPECT_FALSE(at(1.5, 0.3, false));
  EXPECT_EQ(decoder().counts().unknown_id, 1U);
}

// Ways in 16 bits wrap where they end, whichever way the wheel turns.
TEST(OdometerStories, WrapWhereTheirBitsEnd) {
  const std::array<CanSignal, 2> signals{
      CanSignal{"", CanRole::odometer_left, 7, 16, CanByteOrder::motorola, false, 0.01, 0, CanSignal::kNoFaultBit},
      CanSignal{"", CanRole::odometer_right, 23, 16, CanByteOrder::motorola, true, 0.01, 0, CanSignal::kNoFaultBit}};
  const std::array<CanMessage, 1> table{CanMessage{0x20, "", 4, CanChecksum::none, signals}};
  WheelDecoder decoder({table, WheelSource::odometer, 0.5});
  CanFrame frame;
  frame.id = 0x20;
  frame.length = 4;
  frame.data = {0xFF, 0xFF, 0x80, 0x00};
  EXPECT_FALSE(decoder.decode(frame));
  frame.data = {0x00, 0x01, 0x7F, 0xFE};  // 2 forward, 2 back
  frame.received = RigTime::from_ns(20'000'000);
  const auto sample = decoder.decode(frame);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->speed_mps, 0, 1e-12);
  EXPECT_NEAR(sample->yaw_rate_radps, -0.04 / 0.02 / 0.5, 1e-12);
}

}  // namespace
}  // namespace lxd::drivers_wheel_vehicles_test
