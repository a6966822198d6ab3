// SPDX-License-Identifier: Apache-2.0
// Livox SDK2's control protocol: golden frames, every message both ways, and damage.
#include <string>

#include <gtest/gtest.h>

#include "drivers/imu/crc16.hpp"
#include "drivers/livox/control_messages.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/livox_packets.hpp"

namespace lxd::drivers_livox_control_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using test::from_hex;

// Made with the maker's own check values.
constexpr std::string_view kDiscovery = "aa0018000100000000000000000000000000a91f00000000";
constexpr std::string_view kSampling = "aa002100020000000001000000000000000096a56fd5e7ad010000001a00010001";

Bytes encoded(const LivoxControlFrame& frame) {
  std::array<std::uint8_t, kLivoxControlMaxBytes> buffer;
  const auto bytes = encode_livox_control(frame, buffer);
  return {bytes.begin(), bytes.end()};
}

LivoxControlFrame ack(LivoxCommand command, std::span<const std::uint8_t> data) {
  return {7, static_cast<std::uint16_t>(command), LivoxControlKind::kAck, LivoxControlSender::kLidar, data};
}

LivoxParameterWriter sampling() {
  LivoxParameterWriter parameters;
  parameters.add_number(LivoxKey::kWorkMode, static_cast<std::uint64_t>(LivoxWorkMode::kSampling), 1);
  return parameters;
}

TEST(LivoxControlGolden, CheckValueIsTheCataloguesOne) {
  const std::string text = "123456789";
  EXPECT_EQ(crc16({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, kLivoxHeaderCrcInitial), 0x29B1);
}

TEST(LivoxControlGolden, CommandsAreWrittenAsTheMakerDoes) {
  EXPECT_EQ(encoded(livox_discovery(1)), from_hex(kDiscovery));
  const LivoxParameterWriter parameters = sampling();
  EXPECT_EQ(encoded(livox_set_parameters(2, parameters.data())), from_hex(kSampling));
}

TEST(LivoxControlGolden, CommandsAreRead) {
  LivoxControlParser parser;
  LivoxControlFrame frame;
  const Bytes discovery = from_hex(kDiscovery), work_mode = from_hex(kSampling);
  ASSERT_TRUE(parser.parse(discovery, frame));
  EXPECT_TRUE(frame.is(LivoxCommand::kDiscovery, LivoxControlKind::kCommand));
  EXPECT_EQ(frame.sequence, 1U);
  EXPECT_TRUE(frame.data.empty());
  ASSERT_TRUE(parser.parse(work_mode, frame));
  const auto parameters = LivoxParameters::read(frame.data);
  ASSERT_TRUE(parameters);
  EXPECT_EQ(parameters->count(), 1U);
  EXPECT_EQ(parameters->number(LivoxKey::kWorkMode), 1U);
  EXPECT_EQ(parser.counts().frames, 2U);
}

class LivoxControlDamage : public testing::TestWithParam<std::string_view> {};

TEST_P(LivoxControlDamage, AnyOtherLengthIsRefused) {
  const Bytes whole = from_hex(GetParam());
  LivoxControlParser parser;
  LivoxControlFrame frame;
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes));  // its own heap block
    EXPECT_FALSE(parser.parse(cut, frame)) << bytes;
  }
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(parser.parse(longer, frame));
  EXPECT_EQ(parser.counts().bad_size, whole.size() + 1);
}

TEST_P(LivoxControlDamage, AnySingleWrongBitIsRefused) {
  Bytes bytes = from_hex(GetParam());
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    LivoxControlParser parser;
    LivoxControlFrame frame;
    EXPECT_FALSE(parser.parse(bytes, frame)) << bit;
    const LivoxControlCounts& c = parser.counts();
    EXPECT_EQ(c.bad_size + c.bad_start + c.bad_crc + c.bad_kind, 1U);
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
}

INSTANTIATE_TEST_SUITE_P(Golden, LivoxControlDamage, testing::Values(kDiscovery, kSampling));

TEST(LivoxControl, NeitherCommandNorAckIsRefused) {
  for (const BitField field : {kLivoxControl.kind, kLivoxControl.sender}) {
    Bytes bytes = from_hex(kDiscovery);
    field.set(bytes.data(), 2);
    kLivoxControl.header_crc.set(bytes.data(), crc16(std::span(bytes).first(18), kLivoxHeaderCrcInitial));
    LivoxControlParser parser;
    LivoxControlFrame frame;
    EXPECT_FALSE(parser.parse(bytes, frame));
    EXPECT_EQ(parser.counts().bad_kind, 1U);
  }
}

TEST(LivoxControl, FramesWithoutRoomAreNone) {
  std::array<std::uint8_t, kLivoxControlHeaderBytes - 1> buffer;
  EXPECT_TRUE(encode_livox_control(livox_discovery(1), buffer).empty());
  std::array<std::uint8_t, 2000> large;
  const Bytes data(kLivoxControlMaxBytes);
  EXPECT_TRUE(encode_livox_control(livox_set_parameters(1, data), large).empty());
}

TEST(LivoxMessages, DiscoveryIsAnswered) {
  Bytes data{0, static_cast<std::uint8_t>(LivoxDevice::kMid360)};
  for (const char c : std::string("47MDL12345678901")) data.push_back(static_cast<std::uint8_t>(c));
  for (const std::uint8_t byte : Bytes{192, 168, 1, 142, 0x24, 0xDB}) data.push_back(byte);
  LivoxControlParser parser;
  LivoxControlFrame frame;
  const Bytes bytes = encoded(ack(LivoxCommand::kDiscovery, data));
  ASSERT_TRUE(parser.parse(bytes, frame));
  ASSERT_TRUE(frame.is(LivoxCommand::kDiscovery, LivoxControlKind::kAck));
  const auto found = read_livox_discovered(frame.data);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->device, LivoxDevice::kMid360);
  EXPECT_EQ(std::string(found->serial.begin(), found->serial.end()), "47MDL12345678901");
  EXPECT_EQ(found->address, (LivoxAddress{192, 168, 1, 142}));
  EXPECT_EQ(found->control_port, mid360::kControl.sensor);
  for (std::size_t size = 0; size < data.size(); ++size)
    EXPECT_FALSE(read_livox_discovered(std::span(data).first(size))) << size;
}

TEST(LivoxMessages, ParametersAreAnswered) {
  const Bytes data{1, 0x1A, 0x00};
  const auto set = read_livox_parameters_set(data);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->result, 1);
  EXPECT_EQ(set->wrong_key, static_cast<std::uint16_t>(LivoxKey::kWorkMode));
  EXPECT_FALSE(read_livox_parameters_set(std::span(data).first(2)));
}

TEST(LivoxMessages, HostsAreWrittenAsAddressAndPorts) {
  LivoxParameterWriter parameters;
  ASSERT_TRUE(parameters.add_host(LivoxKey::kPointHost, {192, 168, 1, 5}, mid360::kPoints));
  const Bytes wanted{1, 0, 0, 0, 0x06, 0, 8, 0, 192, 168, 1, 5, 0xED, 0xDB, 0xEC, 0xDB};
  EXPECT_EQ(Bytes(parameters.data().begin(), parameters.data().end()), wanted);
}

TEST(LivoxMessages, AWriterWithoutRoomStaysAsItIs) {
  LivoxParameterWriter parameters;
  std::size_t added = 0;
  while (parameters.add_host(LivoxKey::kStateHost, {}, mid360::kState)) ++added;
  EXPECT_EQ(added, 21U);
  ASSERT_TRUE(LivoxParameters::read(parameters.data()));
  EXPECT_EQ(LivoxParameters::read(parameters.data())->count(), 21U);
  EXPECT_FALSE(parameters.add(LivoxKey::kSerial, Bytes(5000)));
}

class LivoxPushedState : public testing::Test {
 protected:
  LivoxPushedState() {
    state_.add_number(LivoxKey::kWorkState, static_cast<std::uint64_t>(LivoxWorkMode::kSampling), 1);
    state_.add_number(LivoxKey::kCoreTemperature, 4'250, 4);
    state_.add_number(LivoxKey::kTimeSync, 1, 1);
    state_.add_number(LivoxKey::kLocalTime, 1'700'000'000'000'000'000, 8);
    state_.add(LivoxKey::kHealth, Bytes(32));
  }
  LivoxParameterWriter state_;
};

TEST_F(LivoxPushedState, IsRead) {
  const auto state = read_livox_state(state_.data());
  ASSERT_TRUE(state);
  EXPECT_EQ(state->mode, LivoxWorkMode::kSampling);
  EXPECT_NEAR(state->core_degC.value(), 42.5, 1e-9);
  EXPECT_EQ(state->time_sync, 1);
  EXPECT_EQ(state->local_time_ns, 1'700'000'000'000'000'000U);
  EXPECT_TRUE(state->healthy);
}

TEST_F(LivoxPushedState, WithAHealthCodeIsNotHealthy) {
  LivoxParameterWriter state;
  state.add_number(LivoxKey::kHealth, 0x0102'0001, 4);
  EXPECT_FALSE(read_livox_state(state.data())->healthy);
  EXPECT_FALSE(read_livox_state(state.data())->mode);
}

TEST_F(LivoxPushedState, CutOrLongerIsRefused) {
  const Bytes data(state_.data().begin(), state_.data().end());
  for (std::size_t size = 0; size < data.size(); ++size)
    EXPECT_FALSE(read_livox_state(Bytes(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(size)))) << size;
  Bytes longer = data;
  longer.push_back(0);
  EXPECT_FALSE(read_livox_state(longer));
}

TEST_F(LivoxPushedState, WithAnyWrongBitStaysWithinItsBytes) {
  Bytes data(state_.data().begin(), state_.data().end());
  for (std::size_t bit = 0; bit < data.size() * 8; ++bit) {
    data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    (void)read_livox_state(Bytes(data));  // its own heap block
    data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
}

TEST_F(LivoxPushedState, AllocatesNothing) {
  std::array<std::uint8_t, kLivoxControlMaxBytes> buffer;
  const AllocationGuard guard;
  LivoxControlParser parser;
  LivoxControlFrame frame;
  const auto bytes = encode_livox_control(livox_set_parameters(3, state_.data()), buffer);
  EXPECT_TRUE(parser.parse(bytes, frame) && read_livox_state(frame.data));
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace lxd::drivers_livox_control_test
