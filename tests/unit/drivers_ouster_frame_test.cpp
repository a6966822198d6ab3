// SPDX-License-Identifier: Apache-2.0
// Packets to frames to sweeps: order, wrap, loss, restart.
#include "drivers/ouster/frame_assembler.hpp"
#include "drivers/ouster/sweep_builder.hpp"
#include "tests/support/replay_ouster.hpp"

namespace lxd::drivers_ouster_frame_test {
namespace {

using namespace replay_test;

class OusterFrames : public testing::Test {
 protected:
  const OusterFrame* add(std::uint32_t frame_id, unsigned column, std::uint64_t time_ns = 0,
                         std::uint32_t range_mm = 1000) {
    EXPECT_TRUE(parser_.parse(
        bytes_ = made_packet(metadata_, frame_id, static_cast<std::uint16_t>(column), time_ns, range_mm), packet_));
    return assembler_.add(packet_);
  }

  OusterMetadata metadata_ = made_metadata("RNG19_RFL8_SIG16_NIR16");
  OusterPacketParser parser_{metadata_.format, metadata_.columns_per_frame, metadata_.init_id};
  OusterFrameAssembler assembler_{metadata_.format, metadata_.columns_per_frame};
  OusterPacket packet_;
  Packet bytes_;
};

TEST_F(OusterFrames, ChangeOfFrameIdEndsTheFrame) {
  EXPECT_EQ(add(5, 0), nullptr);
  EXPECT_EQ(add(5, 16), nullptr);
  const OusterFrame* const frame = add(6, 0);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->frame_id, 5U);
  EXPECT_EQ(frame->columns_present, 32U);
  EXPECT_EQ(frame->present[31], 1);
  EXPECT_EQ(frame->present[32], 0);
}

TEST_F(OusterFrames, FrameIdWraps) {
  EXPECT_EQ(add(65535, 0), nullptr);
  const OusterFrame* const frame = add(0, 0);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->frame_id, 65535U);
  EXPECT_EQ(add(65535, 16), nullptr);
  EXPECT_EQ(assembler_.stale_packets(), 1U);
}

// Given a frame of four packets, then what later frames lack of them is missing; nothing of a frame that nobody has
// seen whole, of one under way, or of places that the sensor's window leaves out.
TEST_F(OusterFrames, PacketsThatAFrameLacksAreCounted) {
  for (const int column : {32, 48}) (void)add(1, column);
  for (const int column : {0, 16, 32}) (void)add(2, column);
  EXPECT_EQ(assembler_.missing_packets(), 0U);
  for (const int column : {16, 48, 48}) (void)add(3, column);
  EXPECT_EQ(assembler_.missing_packets(), 1U) << "the last of frame 2";
  (void)add(4, 0);
  EXPECT_EQ(assembler_.missing_packets(), 3U);
  (void)add(3, 0);
  EXPECT_EQ(assembler_.missing_packets(), 3U) << "one that was overtaken by the next frame is stale, and missing";
}

// A packet that came with no sound column is there.
TEST_F(OusterFrames, PacketWithoutASoundColumnIsNotMissing) {
  for (const std::uint32_t frame : {1U, 2U})
    for (const int column : {0, 16, 32, 48}) (void)add(frame, column);
  (void)add(3, 0);
  bytes_ = made_packet(metadata_, 3, 16, 0, 1000);
  for (std::size_t c = 0; c < metadata_.format.columns_per_packet; ++c)
    metadata_.format.framing().header_status.set(bytes_.data() + metadata_.format.column_offset(c), 0);
  metadata_.format.framing().crc.set(bytes_.data() + metadata_.format.footer_offset(), 0);  // not filled
  EXPECT_TRUE(parser_.parse(bytes_, packet_));
  EXPECT_EQ(packet_.count, 0U);
  assembler_.add(packet_);
  for (const int column : {32, 48}) (void)add(3, column);
  (void)add(4, 0);
  EXPECT_EQ(assembler_.missing_packets(), 0U);
}

TEST_F(OusterFrames, OvertakenPacketIsStaleAndRestartedSensorIsNot) {
  EXPECT_EQ(add(100, 0), nullptr);
  EXPECT_EQ(add(98, 16), nullptr);
  EXPECT_EQ(assembler_.stale_packets(), 1U);
  EXPECT_NE(add(3, 0), nullptr);
  ASSERT_NE(assembler_.flush(), nullptr);
  EXPECT_EQ(assembler_.flush(), nullptr);
}

TEST_F(OusterFrames, FramesThatNeverCameAreCountedAndARestartIsNoGap) {
  for (const std::uint32_t frame : {65534U, 65535U, 3U, 4U}) (void)add(frame, 0);
  EXPECT_EQ(assembler_.missing_frames(), 3U);
  for (const std::uint32_t frame : {20'000U, 1U}) (void)add(frame, 0);
  EXPECT_EQ(assembler_.missing_frames(), 3U);
}

TEST_F(OusterFrames, RepeatedColumnsAreCountedAndTheFirstStays) {
  add(1, 0, 0, 1000);
  add(1, 0, 0, 2000);
  EXPECT_EQ(assembler_.repeated_columns(), 16U);
  EXPECT_EQ(assembler_.flush()->range_mm[0], 1000U);
}

TEST_F(OusterFrames, PacketsInAnyOrderGiveTheSameSweep) {
  OusterSweepBuilder builder(metadata_);
  std::vector<LidarPoint> storage(1000);
  std::vector<std::vector<LidarPoint>> runs;
  for (const std::vector<int>& order : {std::vector<int>{0, 1, 2, 3}, std::vector<int>{2, 0, 3, 1}}) {
    for (const int i : order) add(7, static_cast<std::uint16_t>(16 * i), 1'000'000U + 16'000U * i);
    Sweep sweep;
    sweep.storage = storage;
    ASSERT_TRUE(builder.build(*assembler_.flush(), sweep));
    EXPECT_EQ(sweep.begin.ns(), 1'000'000);
    EXPECT_EQ(sweep.end.ns(), 1'063'000);
    EXPECT_EQ(sweep.stamp, sweep.end);
    runs.emplace_back(sweep.points().begin(), sweep.points().end());
  }
  ASSERT_EQ(runs[0].size(), 256U);
  for (std::size_t i = 0; i < runs[0].size(); ++i) {
    EXPECT_EQ(runs[0][i].x_m, runs[1][i].x_m);
    EXPECT_EQ(runs[0][i].offset_ns, runs[1][i].offset_ns);
  }
}

TEST_F(OusterFrames, ColumnWithADamagedStampIsLeftOut) {
  add(7, 0, 1'000'000'000);
  add(7, 16, 1'000'016'000);
  add(7, 32, 9'000'000'000'000);
  add(7, 48, ~0ULL - 20'000);
  OusterSweepBuilder builder(metadata_);
  std::vector<LidarPoint> storage(1000);
  Sweep sweep;
  sweep.storage = storage;
  ASSERT_TRUE(builder.build(*assembler_.flush(), sweep));
  EXPECT_EQ(builder.counts().bad_column_time, 32U);
  EXPECT_EQ(sweep.count, 32U * 4U);
  EXPECT_EQ((sweep.end - sweep.begin).ns(), 31'000);
}

TEST_F(OusterFrames, FrameWithoutOneReturnIsNoSweep) {
  add(7, 0, 0, 0);
  OusterSweepBuilder builder(metadata_);
  std::vector<LidarPoint> storage(10);
  Sweep sweep;
  sweep.storage = storage;
  EXPECT_FALSE(builder.build(*assembler_.flush(), sweep));
  EXPECT_EQ(builder.counts().no_return, 64U);
}

TEST_F(OusterFrames, PointsAboveCapacityAreCounted) {
  add(7, 0);
  OusterSweepBuilder builder(metadata_);
  std::vector<LidarPoint> storage(10);
  Sweep sweep;
  sweep.storage = storage;
  EXPECT_TRUE(builder.build(*assembler_.flush(), sweep));
  EXPECT_EQ(sweep.count, 10U);
  EXPECT_EQ(builder.counts().above_capacity, 54U);
}

}  // namespace
}  // namespace lxd::drivers_ouster_frame_test
