// SPDX-License-Identifier: Apache-2.0
// The Livox parser against hand-made golden packets, against damage, and the sweeps that are built of its points.
#include <bit>

#include <gtest/gtest.h>

#include "drivers/crc.hpp"
#include "drivers/livox/packet_parser.hpp"
#include "drivers/livox/sweep_builder.hpp"
#include "tests/support/livox_packets.hpp"

namespace lxd::test::drivers_livox_packet_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

LivoxPacket must_parse(const Bytes& bytes) {
  LivoxPacketParser parser(kMid360Lines);
  LivoxPacket packet;
  EXPECT_TRUE(parser.parse(bytes, packet));
  return packet;
}

TEST(LivoxPacketGolden, HeaderAndCartesianPoints) {
  const Bytes bytes = from_hex(kLivoxCartesian);
  const LivoxPacket packet = must_parse(bytes);
  EXPECT_EQ(packet.timestamp_ns, 1767268800123456789U);
  EXPECT_EQ(packet.duration_ns, 480'000U);
  EXPECT_EQ(packet.packet_counter, 7U);
  EXPECT_EQ(packet.frame_counter, 3U);
  EXPECT_EQ(packet.clock, LivoxClock::kPtp);
  ASSERT_EQ(packet.count, 2U);
  EXPECT_TRUE(packet.point(0).p_m.isApprox(Eigen::Vector3f(1.5F, -2.5F, 0.3F)));
  EXPECT_EQ(packet.point(0).reflectivity, 75U);
  EXPECT_EQ(packet.point(0).offset_ns, 0U);
  EXPECT_TRUE(packet.point(1).p_m.isApprox(Eigen::Vector3f(-70, 0.001F, -0.002F)));
  EXPECT_EQ(packet.point(1).tag, 0x20U);
  EXPECT_EQ(packet.point(1).line, 1U);
  EXPECT_EQ(packet.point(1).offset_ns, 240'000U);
}

TEST(LivoxPacketGolden, OtherKindsOfPoints) {
  const Bytes low = from_hex(kLivoxLow), spherical = from_hex(kLivoxSpherical), dual = from_hex(kLivoxDual);
  EXPECT_TRUE(must_parse(low).point(1).p_m.isApprox(Eigen::Vector3f(-70, 0.01F, -0.02F)));
  EXPECT_EQ(must_parse(low).clock, LivoxClock::kUptime);
  EXPECT_LT((must_parse(spherical).point(0).p_m - Eigen::Vector3f(0, -2, 0)).norm(), 1e-6F);
  EXPECT_EQ(must_parse(spherical).clock, LivoxClock::kGps);
  EXPECT_EQ(must_parse(dual).count, 1U);
  EXPECT_TRUE(must_parse(dual).point(0).p_m.isApprox(Eigen::Vector3f(1.5F, -2.5F, 0.3F)));
  EXPECT_EQ(must_parse(dual).echoes(), 2U);
  EXPECT_TRUE(must_parse(dual).point(0, 1).p_m.isApprox(Eigen::Vector3f(0.009F, 0.009F, 0.009F)));
}

TEST(LivoxPacketGolden, Imu) {
  const Bytes bytes = from_hex(kLivoxImu);
  const LivoxPacket packet = must_parse(bytes);
  ASSERT_TRUE(packet.is_imu());
  EXPECT_EQ(packet.imu().timestamp_ns, 1767268800123456789U);
  EXPECT_EQ(packet.imu().gyro_radps, Eigen::Vector3d(0.125, -0.25, 0.5));
  EXPECT_TRUE(packet.imu().accel_mps2.isApprox(Eigen::Vector3d(0, -4.903325, 9.80665)));
}

TEST(LivoxPacket, CrcMatchesTheStandardsCheckValue) {
  const std::string_view text = "123456789";
  EXPECT_EQ(crc32({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}), 0xCBF43926U);
}

class LivoxPacketKinds : public testing::TestWithParam<std::string_view> {};

TEST_P(LivoxPacketKinds, AnyOtherLengthIsRefused) {
  const Bytes whole = from_hex(GetParam());
  LivoxPacketParser parser(kMid360Lines);
  LivoxPacket packet;
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes));  // its own heap block, for ASan
    EXPECT_FALSE(parser.parse(cut, packet));
    if (bytes < kLivoxHeaderBytes) continue;
    Bytes adjusted = cut;  // a header that agrees with the cut
    kLivoxHeader.length.set(adjusted.data(), bytes);
    EXPECT_FALSE(parser.parse(adjusted, packet));
  }
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(parser.parse(longer, packet));
  EXPECT_EQ(parser.counts().bad_size, whole.size() + 1);
  EXPECT_EQ(parser.counts().bad_count, whole.size() - kLivoxHeaderBytes);
}

// What a flipped bit may change unseen: what the check value does not cover and no other field contradicts.
bool unchecked(std::size_t byte) {
  const bool counters = byte >= 7 && byte <= 9, interval = byte == 3 || byte == 4;
  const bool reserved = byte >= 12 && byte < 24, version = byte == 0;
  return counters || interval || reserved || version;
}

TEST_P(LivoxPacketKinds, AnySingleBitFlipIsRefusedOrHarmless) {
  Bytes bytes = from_hex(GetParam());
  const bool has_crc = kLivoxHeader.crc.get(bytes.data()) != 0;
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    LivoxPacketParser parser(kMid360Lines);
    LivoxPacket packet;
    const bool accepted = parser.parse(bytes, packet);
    if (accepted && has_crc) {
      EXPECT_TRUE(unchecked(bit / 8) || bit / 8 == 11) << "bit " << bit;
    }
    if (accepted && !packet.is_imu()) {
      EXPECT_LE(packet.data + packet.count * packet.record->bytes, bytes.data() + bytes.size());
      for (std::uint32_t i = 0; i < packet.count; ++i)
        EXPECT_TRUE(packet.point(i, packet.echoes() - 1).p_m.allFinite());
    }
    const LivoxParserCounts& c = parser.counts();
    EXPECT_EQ(1U, c.packets + c.imu_packets + c.bad_size + c.bad_type + c.bad_time_type + c.bad_count + c.bad_crc +
                      c.bad_time + c.bad_imu_values);
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
}

INSTANTIATE_TEST_SUITE_P(Golden, LivoxPacketKinds,
                         testing::Values(kLivoxCartesian, kLivoxLow, kLivoxSpherical, kLivoxDual, kLivoxImu));

TEST(LivoxPacket, EveryCauseIsCountedAsItself) {
  LivoxPacketParser parser(kMid360Lines);
  LivoxPacket packet;
  const auto refused = [&](const BitField& field, std::uint64_t value) {
    Bytes bytes = from_hex(kLivoxLow);  // has no check value, so that the field itself is met
    field.set(bytes.data(), value);
    EXPECT_FALSE(parser.parse(bytes, packet));
    return parser.counts();
  };
  EXPECT_EQ(refused(kLivoxHeader.data_type, 9).bad_type, 1U);
  EXPECT_EQ(refused(kLivoxHeader.time_type, 3).bad_time_type, 1U);
  EXPECT_EQ(refused(kLivoxHeader.record_count, 0).bad_count, 1U);
  EXPECT_EQ(refused(kLivoxHeader.record_count, 0xFFFF).bad_count, 2U);
  EXPECT_EQ(refused(kLivoxHeader.crc, 1).bad_crc, 1U);
  EXPECT_EQ(refused(kLivoxHeader.timestamp_ns, 1ULL << 62U).bad_time, 1U);
  Bytes imu = from_hex(kLivoxImu);
  kLivoxHeader.crc.set(imu.data(), 0);
  bytes_at(kLivoxHeaderBytes + 8, 4).set(imu.data(), 0x7FC00000);  // not a number
  EXPECT_FALSE(parser.parse(imu, packet));
  EXPECT_EQ(parser.counts().bad_imu_values, 1U);
}

// Sweeps. A packet of four points 25 us apart, of which the third comes from nothing and the fourth is tagged.
struct MadePacket {
  explicit MadePacket(std::uint64_t timestamp_ns) : data(4 * 14) {
    const LivoxRecord& record = *find_livox_record(1);
    for (std::size_t i : {0U, 1U, 3U}) record.x.set(data.data() + i * 14, 1000);
    record.tag.set(data.data() + 3 * 14, 0x08);
    packet.record = &record;
    packet.timestamp_ns = timestamp_ns;
    packet.duration_ns = 100'000;
    packet.count = 4;
    packet.lines = kMid360Lines;
    packet.data = data.data();
  }
  Bytes data;
  LivoxPacket packet;
};

class LivoxSweeps : public testing::Test {
 protected:
  // The points of each sweep that `packet` ended.
  void take(std::uint64_t timestamp_ns, std::uint16_t packet_counter = 0) {
    MadePacket made(timestamp_ns);
    made.packet.packet_counter = packet_counter;
    if (builder_.completes(made.packet)) end();
    builder_.add(made.packet, sweep_);
  }
  void end() {
    if (builder_.close(sweep_)) {
      counts_.push_back(sweep_.count);
      spans_ns_.push_back((sweep_.end - sweep_.begin).ns());
      for (const LidarPoint& p : sweep_.points()) EXPECT_LE(p.offset_ns, spans_ns_.back());
    }
    sweep_.count = 0;
  }
  void SetUp() override { sweep_.storage = storage_; }

  LivoxSweepBuilder builder_{Duration::from_ns(1'000'000)};
  std::array<LidarPoint, 64> storage_;
  Sweep sweep_;
  std::vector<std::uint32_t> counts_;
  std::vector<std::int64_t> spans_ns_;
};

constexpr std::uint64_t kStart_ns = 50'000'000'000, kPacket_ns = 100'000;

TEST_F(LivoxSweeps, HoldAPeriodOfPointsWithoutNoiseAndBlanks) {
  for (std::uint64_t i = 0; i < 25; ++i) take(kStart_ns + i * kPacket_ns);
  end();
  EXPECT_EQ(counts_, (std::vector<std::uint32_t>{20, 20, 10}));
  EXPECT_EQ(spans_ns_.front(), 925'000);
  EXPECT_EQ(builder_.counts().no_return, 25U);
  EXPECT_EQ(builder_.counts().noise_tag, 25U);
  EXPECT_EQ(builder_.counts().missing_packets, 0U);
}

TEST_F(LivoxSweeps, CountLostRepeatedAndOvertakenPackets) {
  // given packet 3 lost, 5 and 6 swapped, 8 twice, and 9 only after the next sweep began
  for (const std::uint64_t i : {0, 1, 2, 4, 6, 5, 7, 8, 8, 10, 9, 11}) take(kStart_ns + i * kPacket_ns);
  end();
  EXPECT_EQ(counts_, (std::vector<std::uint32_t>{16, 4}));
  EXPECT_EQ(builder_.counts().missing_packets, 1U);
  EXPECT_EQ(builder_.counts().repeated_packets, 1U);
  EXPECT_EQ(builder_.counts().late_packets, 1U);
}

TEST_F(LivoxSweeps, GoOnWhenTheSensorRestarts) {
  take(kStart_ns);
  take(kStart_ns + kPacket_ns);
  take(1000);
  take(1000 + kPacket_ns);
  end();
  EXPECT_EQ(counts_, (std::vector<std::uint32_t>{4, 4}));
  EXPECT_EQ(builder_.counts().missing_packets + builder_.counts().late_packets, 0U);
}

TEST_F(LivoxSweeps, FollowAClockThatIsSetBackByLittleAfterThreePackets) {
  for (std::uint64_t i = 0; i < 12; ++i) take(kStart_ns + i * kPacket_ns);
  for (std::uint64_t i = 0; i < 12; ++i) take(kStart_ns - 5'000'000 + i * kPacket_ns);
  end();
  EXPECT_EQ(counts_, (std::vector<std::uint32_t>{20, 4, 18}));
  EXPECT_EQ(builder_.counts().late_packets, 3U);
  EXPECT_EQ(builder_.counts().missing_packets, 0U);
}

TEST_F(LivoxSweeps, TellAClockThatIsSetForwardFromLossByTheCounters) {
  constexpr std::uint64_t kAway_ns = 60'000'000;
  take(kStart_ns, 6);
  take(kStart_ns + kPacket_ns + kAway_ns, 7);
  EXPECT_EQ(builder_.counts().missing_packets, 0U);
  take(kStart_ns + 2 * kPacket_ns + 2 * kAway_ns, 608);
  EXPECT_EQ(builder_.counts().missing_packets, 600U);
}

TEST_F(LivoxSweeps, DropAndCountWhatDoesNotFit) {
  sweep_.storage = std::span(storage_).first(3);
  take(kStart_ns);
  take(kStart_ns + kPacket_ns);
  end();
  EXPECT_EQ(counts_, std::vector<std::uint32_t>{3});
  EXPECT_EQ(builder_.counts().above_capacity, 1U);
}

}  // namespace
}  // namespace lxd::test::drivers_livox_packet_test
