// SPDX-License-Identifier: Apache-2.0
// The faults of a simulated Ouster: what the log says was done is what a driver counts.
#include "drivers/ouster/xyz_table.hpp"
#include "tests/support/decoded_ouster.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::test::simulator_ouster_fault_test {
namespace {

using namespace sim;

FaultPlan faulty(const std::string& name, double begin_s, double end_s, double value = 0) {
  return FaultPlan({{"lidar0_" + name, begin_s, end_s, value}});
}

DecodedOuster written_with(const FaultPlan& plan, LidarLog& log, double duration_s = 2,
                           OusterConfig config = small_ouster()) {
  const LidarRig rig(duration_s, plan, hall(), false);
  const TemporaryFolder folder;
  log = must_write(rig, config, folder.path());
  return decode_ouster(folder / "lidar0.pcap");
}

TEST(SimulatedOusterFault, LostDatagramsAreIncompleteOnes) {
  LidarLog log;
  const DecodedOuster decoded = written_with(faulty("loss", 0.5, 1.5, 0.33), log);
  EXPECT_GT(log.lost, 50U);
  EXPECT_EQ(decoded.capture.ip.incomplete, log.lost);
  EXPECT_EQ(decoded.counts.packets, log.datagrams);
  EXPECT_EQ(log.datagrams + log.lost, 20U * 32);
}

TEST(SimulatedOusterFault, RepeatedDatagramsAreRepeatedColumns) {
  LidarLog log;
  const DecodedOuster decoded = written_with(faulty("duplicate", 0, 9, 0.1), log);
  EXPECT_GT(log.duplicated, 30U);
  EXPECT_EQ(decoded.repeated_columns + 16 * decoded.stale_packets, 16 * log.duplicated);
}

TEST(SimulatedOusterFault, OvertakenDatagramsComeOutOfOrderAndNoneIsMissing) {
  LidarLog log;
  const DecodedOuster decoded = written_with(faulty("reorder", 0, 9, 0.1), log);
  std::uint64_t backwards = 0;
  for (std::size_t i = 16; i < decoded.pixels.size(); i += 16) {
    backwards += decoded.pixels[i].stamp_ns < decoded.pixels[i - 16].stamp_ns ? 1 : 0;
  }
  EXPECT_GT(log.reordered, 30U);
  EXPECT_EQ(backwards, log.reordered);
  EXPECT_EQ(decoded.counts.packets, 20U * 32);
}

TEST(SimulatedOusterFault, OffIsSilence) {
  LidarLog log;
  const DecodedOuster decoded = written_with(faulty("off", 0.5, 1.0), log);
  EXPECT_EQ(log.silenced, 5U * 32 + 1);  // the packet that would have been sent at 0.5 s is not
  EXPECT_EQ(decoded.counts.packets, 15U * 32 - 1);
  EXPECT_EQ(decoded.capture.to(7503).size(), 150U);
  EXPECT_EQ(decoded.pixels.back().frame_id, 19U);  // it went on counting
}

TEST(SimulatedOusterFault, RestartBeginsAnew) {
  LidarLog log;
  OusterConfig config = small_ouster();
  config.clock_source = "TIME_FROM_INTERNAL_OSC";
  const DecodedOuster decoded = written_with(faulty("restart", 0.5, 1.5), log, 2, config);
  EXPECT_EQ(log.silenced, 10U * 32 + 1);
  EXPECT_EQ(log.other_init_id, 5U * 32);
  EXPECT_EQ(decoded.counts.bad_init_id, OusterPacketParser::kRestartPackets - 1U);  // then it is followed
  EXPECT_EQ(decoded.counts.restarts, 1U);
  const auto points = decoded.capture.to(7502);
  const OusterFraming& framing = decoded.metadata.format.framing();
  const std::uint8_t* const resumed = points[5 * 32 - 1]->bytes.data();
  EXPECT_EQ(framing.packet_frame_id.get(resumed), 0U);
  EXPECT_EQ(framing.timestamp_ns.get(resumed + 32), 1'000'000'000U);
}

TEST(SimulatedOusterFault, AnotherSensorOrFirmwareIsRefusedPacketByPacket) {
  LidarLog log;
  const DecodedOuster serial = written_with(faulty("serial", 1, 9), log);
  EXPECT_EQ(log.other_serial, 10U * 32);
  EXPECT_EQ(serial.counts.bad_serial, log.other_serial);
  const DecodedOuster profile = written_with(faulty("profile", 1, 9), log);
  EXPECT_EQ(log.other_profile, 10U * 32);
  EXPECT_EQ(profile.counts.bad_size, log.other_profile);
}

TEST(SimulatedOusterFault, SweepsWithoutColumnsOrRangesOrAllInOnePlaceOrFull) {
  LidarLog log;
  const DecodedOuster empty = written_with(faulty("empty", 0.45, 0.55), log);
  EXPECT_EQ(log.emptied, 32U);
  EXPECT_EQ(empty.counts.invalid_column, 512U);
  const DecodedOuster zero = written_with(faulty("zero", 0.45, 0.55), log);
  EXPECT_EQ(std::count_if(zero.pixels.begin(), zero.pixels.end(), [](const auto& p) { return p.range_mm == 0; }),
            512 * 16);
  const DecodedOuster voxel = written_with(faulty("one_voxel", 0.45, 0.55), log);
  const OusterXyzTable table(voxel.metadata);
  Eigen::AlignedBox3f box;
  int points = 0;
  for (const auto& p : voxel.pixels) {
    if (p.frame_id != 5 || p.range_mm == 0) continue;
    box.extend(table.point(p.column * 16 + p.row, p.range_mm));
    ++points;
  }
  EXPECT_LT(box.sizes().maxCoeff(), 0.6F);
  EXPECT_GT(box.center().norm(), small_ouster().returns.range_min_m) << "beyond the blind zone";
  EXPECT_GT(points, 20);
  OusterConfig blind = small_ouster();
  blind.returns.range_max_m = 1;  // sees nothing
  const DecodedOuster full = written_with(faulty("max_points", 0.45, 0.55), log, 1, blind);
  EXPECT_EQ(log.returns, 512U * 16);
}

TEST(SimulatedOusterFault, ClockStepsAndSkewsAreInTheStamps) {
  LidarLog log;
  const DecodedOuster before = written_with({}, log);
  const DecodedOuster step = written_with(faulty("time_step", 1, 9, -0.25), log);
  const DecodedOuster skew = written_with(faulty("skew", 1, 1.5, 100), log);
  const auto shift = [&](const DecodedOuster& other, std::size_t i) {
    return other.pixels[i].stamp_ns - before.pixels[i].stamp_ns;
  };
  EXPECT_EQ(shift(step, 0), 0);
  EXPECT_EQ(shift(step, before.pixels.size() - 1), -250'000'000);
  EXPECT_EQ(shift(skew, before.pixels.size() / 2), 0);
  EXPECT_NEAR(static_cast<double>(shift(skew, before.pixels.size() - 1)), 50'000, 1);
}

}  // namespace
}  // namespace lxd::test::simulator_ouster_fault_test
