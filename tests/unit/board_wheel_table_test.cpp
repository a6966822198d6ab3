// SPDX-License-Identifier: Apache-2.0
// A vehicle that the rig file describes itself: its messages are read, written back, decoded, and every error names its
// key.
#include <gtest/gtest.h>

#include "board/rig_file.hpp"
#include "board/rig_text.hpp"
#include "board/wheel_table.hpp"

namespace lxd::board_wheel_table_test {
namespace {

constexpr std::string_view kTable = R"(reference: wheel
lidar0: {beams: 16, columns: 512}
wheel:
  protocol: table
  kinematics: ackermann
  wheelbase_m: 0.65
  messages:
    - id: 0x18FF0102
      extended: true
      length: 6
      checksum: xor
      signals:
        - {role: speed, start_bit: 0, bits: 16, byte_order: intel, sign: signed, scale: 0.001}
        - {role: steering_angle, start_bit: 23, bits: 12, byte_order: motorola, sign: unsigned, scale: 0.001, offset: -2, fault_bit: 40}
)";

RigFile parse(std::string_view text) { return parse_rig(std::string(text), "rig.yaml"); }

// The table with one of its parts exchanged.
std::string with(std::string_view part, std::string_view other) {
  std::string text(kTable);
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), other);
}

std::string complaints_with(std::string_view part, std::string_view other) {
  return text_of(parse(with(part, other)).problems);
}

void expect_complaint(std::string_view part, std::string_view other, std::string_view wanted) {
  const std::string said = complaints_with(part, other);
  EXPECT_NE(said.find(wanted), std::string::npos) << "of " << other << ": " << said;
}

TEST(BoardWheelTable, DecodesWhatItDescribes) {
  const RigFile file = parse(kTable);
  ASSERT_TRUE(file.ok()) << text_of(file.problems);
  const std::vector<CanMessage> messages = wheel_messages(*file.rig.wheel);
  WheelDecoder decoder(wheel_decoder_config(*file.rig.wheel, messages));
  CanFrame frame;
  frame.id = 0x18FF0102;
  frame.extended = true;
  frame.length = 6;
  frame.data = {0xDC, 0x05, 0x83, 0x40, 0x00, 0};  // 1500; 0x834: 2100
  set_checksum(messages[0], frame.data);
  const auto sample = decoder.decode(frame);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->speed_mps, 1.5, 1e-12);
  EXPECT_NEAR(sample->yaw_rate_radps, 1.5 * std::tan(0.1) / 0.65, 1e-12);
}

TEST(BoardWheelTable, IsWrittenSoThatItReadsBackTheSame) {
  const RigFile first = parse(kTable);
  ASSERT_TRUE(first.ok());
  const std::string text = rig_text(first.rig);
  const RigFile again = parse(text);
  ASSERT_TRUE(again.ok()) << text << text_of(again.problems);
  EXPECT_EQ(rig_text(again.rig), text);
  EXPECT_EQ(again.rig.wheel->messages[0].signals[1].offset, -2);
  EXPECT_EQ(again.rig.wheel->messages[0].signals[1].fault_bit, 40);
  EXPECT_EQ(again.rig.wheel->messages[0].checksum, CanChecksum::exclusive_or);
  EXPECT_EQ(again.rig.wheel->kinematics, "ackermann");
}

TEST(BoardWheelTable, VehiclesThatAreKnownHaveTheirUsualKinematics) {
  for (const Vehicle& vehicle : kVehicles) {
    const RigFile file = parse("lidar0: {}\nwheel: {protocol: " + std::string(vehicle.name) + "}\n");
    ASSERT_TRUE(file.ok()) << text_of(file.problems);
    EXPECT_EQ(wheel_source(*file.rig.wheel), vehicle.source);
    EXPECT_EQ(wheel_messages(*file.rig.wheel).size(), vehicle.messages().size());
  }
}

TEST(BoardWheelTable, ErrorsNameTheKey) {
  expect_complaint("id: 0x18FF0102", "id: 0x38FF0102",
                   "wheel.messages[0].id: found '0x38FF0102', wanted a number in 0");
  expect_complaint("id: 0x18FF0102", "id: abc", "wheel.messages[0].id: found 'abc'");
  expect_complaint("      extended: true\n", "", "need extended: true");
  expect_complaint("length: 6", "length: 9", "wheel.messages[0].length: found 9");
  expect_complaint("checksum: xor", "checksum: crc", "wheel.messages[0].checksum: found 'crc', wanted none or toyota");
  expect_complaint("role: speed", "role: pace", "wheel.messages[0].signals[0].role: found 'pace'");
  expect_complaint("start_bit: 0", "start_bit: 64", "wheel.messages[0].signals[0].start_bit: found 64");
  expect_complaint("start_bit: 0", "start_bit: 40", "wheel.messages[0].signals[0].bits: found 16 bits from bit 40");
  expect_complaint("bits: 16", "bits: 33", "wheel.messages[0].signals[0].bits: found 33");
  expect_complaint("bits: 16, ", "", "wheel.messages[0].signals[0].bits: found nothing");
  expect_complaint("byte_order: intel", "byte_order: big", "wheel.messages[0].signals[0].byte_order: found 'big'");
  expect_complaint("sign: signed", "sign: 2s", "wheel.messages[0].signals[0].sign: found '2s'");
  expect_complaint("scale: 0.001}", "scale: 0}", "wheel.messages[0].signals[0].scale: found 0");
  expect_complaint("scale: 0.001}", "factor: 0.001}", "wheel.messages[0].signals[0].factor: unknown key");
  expect_complaint("fault_bit: 40", "fault_bit: 48", "wheel.messages[0].signals[1].fault_bit: found 48");
}

TEST(BoardWheelTable, WhatDoesNotGoTogetherIsRefused) {
  expect_complaint("role: speed", "role: steering_angle", "found 2 signals with the role steering_angle");
  expect_complaint("role: speed", "role: other", "wheel.kinematics: found ackermann, which needs speed");
  expect_complaint("kinematics: ackermann", "kinematics: four_wheel", "needs front_left; the messages of table");
  expect_complaint("  wheelbase_m: 0.65\n", "", "wheel.wheelbase_m: found nothing, wanted the way between the axles");
  expect_complaint("protocol: table", "protocol: toyota", "wheel.messages: found a table, wanted protocol: table");
  const std::string none = text_of(parse("lidar0: {}\nwheel: {protocol: table}\n").problems);
  EXPECT_NE(none.find("wheel.messages: found nothing, wanted a list of 1 to 16"), std::string::npos) << none;
}

}  // namespace
}  // namespace lxd::board_wheel_table_test
