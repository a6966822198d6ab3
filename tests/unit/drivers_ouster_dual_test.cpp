// SPDX-License-Identifier: Apache-2.0
// Profiles with two returns: both reach the sweep, the first ones first, and the first ones win where room is short.
#include <gtest/gtest.h>

#include "drivers/ouster/sweep_builder.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/replay_ouster.hpp"

namespace lxd::drivers_ouster_dual_test {
namespace {

using replay_test::made_metadata;
using replay_test::made_packet;
using replay_test::Packet;

// A turn whose pixels all have a first return at 5.6 m; every second pixel has another one at 9.6 m. Distances are
// whole steps of every profile.
class DualReturns : public testing::TestWithParam<const char*> {
 protected:
  static constexpr std::size_t kPixels = 64 * 4;

  const OusterFrame* frame() {
    for (std::uint16_t column = 0; column < 64; column += 16) {
      const Packet bytes = packet(column);  // the columns point into them
      if (parser_.parse(bytes, packet_)) assembler_.add(packet_);
    }
    return assembler_.flush();
  }
  [[nodiscard]] Packet packet(std::uint16_t first_column) const {
    Packet bytes = made_packet(metadata_, 3, first_column, 1'000'000U + 1000U * first_column, 5600);
    const OusterPacketFormat& format = metadata_.format;
    for (std::size_t c = 0; c < 16; ++c) {
      for (std::size_t row = 0; row < 4; row += 2) {
        std::uint8_t* const block = bytes.data() + format.column_offset(c) + format.framing().column_header_bytes +
                                    row * format.profile->channel_bytes;
        format.profile->fields.range2_mm.set(block, 9600);
        format.profile->fields.reflectivity2.set(block, 7);
      }
    }
    const BitField& crc = format.framing().crc;
    if (crc.present()) crc.set(bytes.data() + format.footer_offset(), crc64(std::span(bytes).first(bytes.size() - 8)));
    return bytes;
  }
  bool build(std::size_t capacity) {
    storage_.resize(capacity);
    sweep_.storage = storage_;
    const OusterFrame* const turn = frame();
    return turn != nullptr && builder_.build(*turn, sweep_);
  }

  OusterMetadata metadata_ = made_metadata(GetParam());
  OusterPacketParser parser_{metadata_.format, metadata_.columns_per_frame, 77};
  OusterPacket packet_;
  OusterFrameAssembler assembler_{metadata_.format, metadata_.columns_per_frame};
  OusterSweepBuilder builder_{metadata_};
  std::vector<LidarPoint> storage_;
  Sweep sweep_;
};

double range_m(const LidarPoint& p) { return std::sqrt(p.x_m * p.x_m + p.y_m * p.y_m + p.z_m * p.z_m); }

TEST_P(DualReturns, SecondOnesComeBehindAllFirstOnes) {
  ASSERT_TRUE(build(1000));
  ASSERT_EQ(sweep_.count, kPixels + kPixels / 2);
  for (std::size_t i = 0; i < sweep_.count; ++i) {
    const LidarPoint& p = sweep_.points()[i];
    EXPECT_NEAR(range_m(p), i < kPixels ? 5.6 : 9.6, 1e-5) << i;
    EXPECT_EQ(p.intensity, i < kPixels ? 50 : 7) << i;
  }
  // Both returns of a pixel have one direction and one instant.
  const LidarPoint &first = sweep_.points()[2], &second = sweep_.points()[kPixels + 1];
  EXPECT_EQ(first.offset_ns, second.offset_ns);
  EXPECT_NEAR(first.x_m / 5.6, second.x_m / 9.6, 1e-6);
  EXPECT_EQ(builder_.counts().second_returns, kPixels / 2);
  EXPECT_EQ(builder_.counts().no_return, 0U);
}

TEST_P(DualReturns, WithoutRoomFirstOnesAreKept) {
  ASSERT_TRUE(build(kPixels + 10));
  EXPECT_EQ(sweep_.count, kPixels + 10);
  EXPECT_NEAR(range_m(sweep_.points()[kPixels - 1]), 5.6, 1e-5);
  EXPECT_NEAR(range_m(sweep_.points()[kPixels]), 9.6, 1e-5);
  EXPECT_EQ(builder_.counts().above_capacity, kPixels / 2 - 10);
  EXPECT_EQ(builder_.counts().second_returns, 10U);
}

TEST_P(DualReturns, FramesAndSweepsAllocateNothing) {
  storage_.resize(1000);
  sweep_.storage = storage_;
  std::vector<Packet> packets;
  for (std::uint16_t column = 0; column < 64; column += 16) packets.push_back(packet(column));
  const AllocationGuard guard;
  for (const Packet& bytes : packets) {
    ASSERT_TRUE(parser_.parse(bytes, packet_));
    assembler_.add(packet_);
  }
  const OusterFrame* const turn = assembler_.flush();
  EXPECT_TRUE(turn != nullptr && builder_.build(*turn, sweep_));
  EXPECT_EQ(guard.count(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Profiles, DualReturns,
                         testing::Values("RNG19_RFL8_SIG16_NIR16_DUAL", "RNG15_RFL8_NIR8_DUAL",
                                         "FUSA_RNG15_RFL8_NIR8_DUAL", "FIVE_WORD_PIXEL"),
                         [](const auto& param) { return std::string(param.param); });

TEST(SingleReturns, HaveNoStorageForSecondOnes) {
  const OusterMetadata metadata = made_metadata("RNG19_RFL8_SIG16_NIR16");
  OusterFrameAssembler assembler(metadata.format, metadata.columns_per_frame);
  OusterPacketParser parser(metadata.format, metadata.columns_per_frame, 77);
  OusterPacket packet;
  const Packet bytes = made_packet(metadata, 1, 0, 0, 5000);  // the columns point into them
  ASSERT_TRUE(parser.parse(bytes, packet));
  assembler.add(packet);
  EXPECT_TRUE(assembler.flush()->range2_mm.empty());
}

}  // namespace
}  // namespace lxd::drivers_ouster_dual_test
