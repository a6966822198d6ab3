// SPDX-License-Identifier: Apache-2.0
// The packet parser against real captures (whose decoded fields ouster-sdk keeps digests of) and against damage.
#include <fstream>

#include <nlohmann/json.hpp>

#include "drivers/ouster/packet_parser.hpp"
#include "tests/support/replay_md5.hpp"
#include "tests/support/replay_ouster.hpp"

namespace lxd::drivers_ouster_packet_test {
namespace {

using namespace replay_test;

struct Capture {
  std::vector<Packet> packets;
  OusterMetadata metadata;
  nlohmann::json digest;
};

Capture load(const std::string& name) {
  Capture capture;
  capture.metadata = must_read_metadata(clone_ouster() / (name + ".json"));
  capture.packets = datagrams(clone_ouster() / (name + ".pcap"), capture.metadata.format.packet_bytes());
  std::ifstream(clone_ouster() / (name + "_digest.json")) >> capture.digest;
  return capture;
}

OusterPacketParser parser_for(const OusterMetadata& m) { return {m.format, m.columns_per_frame, m.init_id}; }

void append(Md5& md5, std::uint64_t value, int bytes) {
  std::array<std::uint8_t, 8> le{};
  for (int i = 0; i < bytes; ++i) le[i] = static_cast<std::uint8_t>(value >> (8 * i));
  md5.update(std::span(le).first(bytes));
}

// The SDK's way: of each packet the field as an image, row by row, in an integer of `bytes` bytes.
std::string field_digest(const Capture& capture, const BitField& field, int bytes) {
  Md5 md5;
  auto parser = parser_for(capture.metadata);
  OusterPacket packet;
  const OusterPacketFormat& format = capture.metadata.format;
  for (const Packet& bytes_of_packet : capture.packets) {
    EXPECT_TRUE(parser.parse(bytes_of_packet, packet));
    for (std::size_t row = 0; row < format.pixels_per_column; ++row) {
      for (const OusterColumn& column : packet.columns()) {
        append(md5, field.get(column.channels + row * format.profile->channel_bytes), bytes);
      }
    }
  }
  return md5.hex();
}

std::string column_digest(const Capture& capture, bool times) {
  Md5 md5;
  auto parser = parser_for(capture.metadata);
  OusterPacket packet;
  for (const Packet& bytes : capture.packets) {
    EXPECT_TRUE(parser.parse(bytes, packet));
    for (const OusterColumn& column : packet.columns()) {
      times ? append(md5, column.timestamp_ns, 8) : append(md5, column.measurement_id, 2);
    }
  }
  return md5.hex();
}

void expect_digest(const Capture& capture, const char* name, const BitField& field, int bytes) {
  EXPECT_EQ(field_digest(capture, field, bytes), capture.digest["packet_hash"][name].get<std::string>()) << name;
}

TEST(OusterPacketGolden, LegacyFieldsMatchTheVendorsDigest) {
  const Capture capture = load("OS-1-32-G_v2.1.1_1024x10");
  ASSERT_EQ(capture.packets.size(), 64U);
  const OusterChannelFields& f = capture.metadata.format.profile->fields;
  expect_digest(capture, "RANGE", f.range_mm, 4);
  expect_digest(capture, "SIGNAL", f.signal, 2);
  expect_digest(capture, "REFLECTIVITY", f.reflectivity, 1);
  expect_digest(capture, "NEAR_IR", f.near_ir, 2);
  expect_digest(capture, "FLAGS", f.flags, 1);
  EXPECT_EQ(column_digest(capture, true), capture.digest["packet_hash"]["TIMESTAMP"].get<std::string>());
  EXPECT_EQ(column_digest(capture, false), capture.digest["packet_hash"]["MEASUREMENT_ID"].get<std::string>());
}

TEST(OusterPacketGolden, DualReturnFieldsMatchTheVendorsDigest) {
  const Capture capture = load("OS-0-32-U1_v2.2.0_1024x10");
  ASSERT_EQ(capture.packets.size(), 64U);
  const OusterChannelFields& f = capture.metadata.format.profile->fields;
  expect_digest(capture, "RANGE", f.range_mm, 4);
  expect_digest(capture, "RANGE2", f.range2_mm, 4);
  expect_digest(capture, "SIGNAL", f.signal, 2);
  expect_digest(capture, "SIGNAL2", f.signal2, 2);
  expect_digest(capture, "REFLECTIVITY", f.reflectivity, 1);
  expect_digest(capture, "REFLECTIVITY2", f.reflectivity2, 1);
  expect_digest(capture, "NEAR_IR", f.near_ir, 2);
  expect_digest(capture, "FLAGS", f.flags, 1);
  expect_digest(capture, "FLAGS2", f.flags2, 1);
  EXPECT_EQ(column_digest(capture, true), capture.digest["packet_hash"]["TIMESTAMP"].get<std::string>());
}

TEST(OusterPacket, MadePacketIsReadBack) {
  for (const OusterProfile& profile : ouster_profiles()) {
    const OusterMetadata metadata = made_metadata(profile.name.data());
    auto parser = parser_for(metadata);
    const auto bytes = made_packet(metadata, 9, 32, 5000, 4000);  // the columns point into them
    OusterPacket packet;
    ASSERT_TRUE(parser.parse(bytes, packet)) << profile.name;
    EXPECT_EQ(packet.frame_id, 9U);
    ASSERT_EQ(packet.columns().size(), 16U);
    EXPECT_EQ(packet.columns()[3].measurement_id, 35U);
    EXPECT_EQ(packet.columns()[3].timestamp_ns, 8000U);
    EXPECT_EQ(profile.fields.range_mm.get(packet.columns()[3].channels), 4000U);
  }
}

TEST(OusterPacket, AnyOtherLengthIsRefused) {
  const OusterMetadata metadata = made_metadata("RNG15_RFL8_NIR8");
  const Packet whole = made_packet(metadata, 1, 0, 0, 1000);
  auto parser = parser_for(metadata);
  OusterPacket packet;
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    const Packet cut(whole.begin(),
                     whole.begin() + static_cast<std::ptrdiff_t>(bytes));  // its own heap block, for ASan
    EXPECT_FALSE(parser.parse(cut, packet));
  }
  Packet longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(parser.parse(longer, packet));
  EXPECT_EQ(parser.counts().bad_size, whole.size() + 1);
  EXPECT_EQ(parser.counts().packets, 0U);
}

TEST(OusterPacket, AnySingleBitFlipIsRefusedByTheCheckValue) {
  const OusterMetadata metadata = made_metadata("RNG15_RFL8_NIR8");
  Packet bytes = made_packet(metadata, 1, 0, 0, 1000);
  auto parser = parser_for(metadata);
  OusterPacket packet;
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_FALSE(parser.parse(bytes, packet)) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
  EXPECT_TRUE(parser.parse(bytes, packet));
}

TEST(OusterPacket, AnySingleBitFlipWithoutCheckValueStaysWithinTheFrame) {
  const OusterMetadata metadata = made_metadata("LEGACY");
  Packet bytes = made_packet(metadata, 1, 0, 0, 1000);
  auto parser = parser_for(metadata);
  OusterPacket packet;
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    ASSERT_TRUE(parser.parse(bytes, packet));
    for (const OusterColumn& column : packet.columns()) {
      EXPECT_LT(column.measurement_id, metadata.columns_per_frame);
      EXPECT_GE(column.channels, bytes.data());
      EXPECT_LE(column.channels + 4 * 12, bytes.data() + bytes.size());
    }
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
  const OusterParserCounts& counts = parser.counts();
  EXPECT_EQ(counts.invalid_column, 16U);  // the one bit of status that counts, in each column
  EXPECT_GT(counts.bad_measurement_id, 0U);
  EXPECT_GT(counts.bad_column_frame_id, 0U);
}

TEST(OusterPacket, FirmwareWithoutCheckValueIsAccepted) {
  const OusterMetadata metadata = made_metadata("RNG15_RFL8_NIR8");
  auto parser = parser_for(metadata);
  OusterPacket packet;
  for (const std::uint64_t filler : {std::uint64_t{0}, std::uint64_t{0xDEADBEEF0000C0DEULL}}) {
    Packet bytes = made_packet(metadata, 1, 0, 0, 1000);
    bytes_at(static_cast<int>(bytes.size()) - 8, 8).set(bytes.data(), filler);
    EXPECT_TRUE(parser.parse(bytes, packet));
  }
}

TEST(OusterPacket, OtherSensorAndOtherPacketTypesAreRefusedByCause) {
  const OusterMetadata metadata = made_metadata("RNG19_RFL8_SIG16_NIR16");
  auto parser = parser_for(metadata);
  OusterPacket packet;
  EXPECT_FALSE(parser.parse(made_packet(metadata, 1, 0, 0, 1000, 78), packet));
  EXPECT_EQ(parser.counts().bad_init_id, 1U);
  Packet imu = made_packet(metadata, 1, 0, 0, 1000);
  imu[0] = 2;
  EXPECT_FALSE(parser.parse(imu, packet));
  EXPECT_EQ(parser.counts().bad_packet_type, 1U);
}

TEST(OusterPacket, AnotherSerialNumberThanTheMetadatasIsRefused) {
  const Capture capture = load("OS-0-32-U1_v2.2.0_1024x10");
  const OusterMetadata& m = capture.metadata;
  EXPECT_EQ(m.serial, 992137000142U);
  OusterPacketParser right(m.format, m.columns_per_frame, m.init_id, m.serial);
  OusterPacketParser wrong(m.format, m.columns_per_frame, m.init_id, *m.serial + 1);
  OusterPacket packet;
  EXPECT_TRUE(right.parse(capture.packets[0], packet));
  EXPECT_FALSE(wrong.parse(capture.packets[0], packet));
  EXPECT_EQ(wrong.counts().bad_serial, 1U);
}

// Given the metadata of an earlier run of a sensor, when its packets of the next run come, then the first ones are
// refused and the others accepted; without a serial number to know it by, all are refused.
TEST(OusterPacket, ASensorThatRestartedIsFollowedAndAStrangerIsNot) {
  const Capture capture = load("OS-0-32-U1_v2.2.0_1024x10");
  const OusterMetadata& m = capture.metadata;
  OusterPacketParser known(m.format, m.columns_per_frame, *m.init_id + 1, m.serial);
  OusterPacketParser unknown(m.format, m.columns_per_frame, *m.init_id + 1);
  OusterPacket packet;
  constexpr int kRefused = OusterPacketParser::kRestartPackets - 1;
  for (int i = 0; i < 2 * OusterPacketParser::kRestartPackets; ++i) {
    EXPECT_EQ(known.parse(capture.packets[0], packet), i >= kRefused) << i;
    EXPECT_FALSE(unknown.parse(capture.packets[0], packet));
  }
  EXPECT_EQ(known.counts().bad_init_id, std::uint64_t{kRefused});
  EXPECT_EQ(known.counts().restarts, 1U);
  EXPECT_EQ(unknown.counts().restarts, 0U);
}

TEST(OusterPacket, ColumnsThatTheSensorCallsInvalidAreLeftOut) {
  const OusterMetadata metadata = made_metadata("LEGACY");
  Packet bytes = made_packet(metadata, 1, 0, 0, 1000);
  bytes[metadata.format.column_bytes() - 4] = 0;
  auto parser = parser_for(metadata);
  OusterPacket packet;
  ASSERT_TRUE(parser.parse(bytes, packet));
  ASSERT_EQ(packet.columns().size(), 15U);
  EXPECT_EQ(packet.columns()[0].measurement_id, 1U);
  EXPECT_EQ(parser.counts().invalid_column, 1U);
}

// By the definition, bit by bit, for every length around the width of the slices.
TEST(Crc64, IsThatOfTheDefinition) {
  std::vector<std::uint8_t> bytes;
  for (unsigned i = 0; i < 40; ++i) {
    std::uint64_t crc = ~0ULL;
    for (const std::uint8_t byte : bytes) {
      crc ^= byte;
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xC96C5795D7870F42ULL : crc >> 1U;
    }
    EXPECT_EQ(crc64(bytes), ~crc) << bytes.size();
    bytes.push_back(static_cast<std::uint8_t>(37 * i + 11));
  }
}

TEST(Crc64, MatchesTheStandardsCheckValue) {
  const std::string text = "123456789";
  EXPECT_EQ(crc64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}), 0x995DC9BBDF1939FAULL);
}

}  // namespace
}  // namespace lxd::drivers_ouster_packet_test
