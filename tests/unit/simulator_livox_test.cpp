// SPDX-License-Identifier: Apache-2.0
// A simulated Mid-360, read back by the product's own parser: every point where the surface is, a scan that does not
// repeat, and every fault counted as it was made.
#include <set>

#include "drivers/livox/packet_parser.hpp"
#include "drivers/livox/sweep_builder.hpp"
#include "tests/support/captured_datagrams.hpp"
#include "tests/support/lidar_rig.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/lidar/livox_pattern.hpp"
#include "tools/simulator/lidar/livox_writer.hpp"

namespace lxd::test::simulator_livox_test {
namespace {

using namespace sim;

constexpr std::uint16_t kPoints = 56301, kImu = 56401;

LivoxConfig exact_config() {
  LivoxConfig config;
  config.clock_source = "PTP";
  return without_errors(config);
}

FaultPlan faulty(const std::string& name, double begin_s, double end_s, double value = 0) {
  return FaultPlan({{"lidar0_" + name, begin_s, end_s, value}});
}

struct Decoded {
  LidarLog log;
  Capture capture;
  LivoxParserCounts counts;
  LivoxSweepCounts sweep_counts;
  std::vector<Sweep> sweeps;  // without their points
  std::vector<LidarPoint> last_points;
};

Decoded decoded(const LidarRig& rig, const LivoxConfig& config) {
  Decoded d;
  const TemporaryFolder folder;
  const auto log = write_livox(rig.context, config, folder.path());
  if (!log) {
    ADD_FAILURE() << log.error().message;
    return d;
  }
  d.log = *log;
  d.capture = read_capture(folder / "lidar0.pcap");
  LivoxPacketParser parser(kMid360Lines);
  LivoxSweepBuilder builder(Duration::from_ns(kLivoxFrame_ns));
  std::vector<LidarPoint> storage(40000);
  Sweep sweep;
  sweep.storage = storage;
  const auto close = [&] {
    if (builder.close(sweep)) d.sweeps.push_back(sweep);
    if (sweep.count > 0) d.last_points.assign(sweep.points().begin(), sweep.points().end());
    sweep.count = 0;
  };
  LivoxPacket packet;
  for (const CapturedDatagram* const datagram : d.capture.to(kPoints)) {
    if (!parser.parse(datagram->bytes, packet)) continue;
    if (builder.completes(packet)) close();
    builder.add(packet, sweep);
  }
  close();
  d.counts = parser.counts();
  d.sweep_counts = builder.counts();
  return d;
}

TEST(SimulatedLivox, PointsLieOnTheSurfaceAtTheirOwnTime) {
  // given a sensor without errors that moves and turns
  LidarRig rig(0.2);
  LivoxConfig config = exact_config();
  config.T_body_sensor = rig.T_body_sensor;
  // when its last sweep is decoded
  const Decoded d = decoded(rig, config);
  ASSERT_EQ(d.sweeps.size(), 2U);
  EXPECT_EQ(d.log.returns, d.log.shots);
  EXPECT_EQ(d.sweeps[0].count + d.sweeps[1].count, 417U * 96);
  // then each point is on the surface, but for half a millimetre an axis on the wire
  double worst_m = 0;
  for (const LidarPoint& p : d.last_points) {
    const RigTime t = d.sweeps[1].begin + Duration::from_ns(p.offset_ns);
    const Eigen::Vector3d p_world =
        rig.to_world((t - rig.context.start).seconds(), Eigen::Vector3d(p.x_m, p.y_m, p.z_m));
    worst_m = std::max(worst_m, surface_distance_m(rig.world, p_world));
  }
  EXPECT_LT(worst_m, 0.0009);  // sqrt(3) / 2 mm, and what float costs
  RecordProperty("worst_um", static_cast<int>(worst_m * 1e6));
}

TEST(SimulatedLivox, ScanFillsItsFieldOfViewAndDoesNotRepeat) {
  constexpr double kCell_rad = 3 * std::numbers::pi / 180;
  std::set<std::pair<int, int>> cells;
  std::vector<std::size_t> seen;
  double low = 1, high = -1;
  for (std::uint64_t frame = 0; frame < 5; ++frame) {
    for (std::uint64_t shot = 0; shot < 20000; ++shot) {
      const Eigen::Vector3d ray = livox_direction(livox_shot_s(livox_first_packet(frame), shot), shot % kLivoxLines);
      const double elevation = std::asin(ray.z());
      low = std::min(low, elevation);
      high = std::max(high, elevation);
      cells.insert({static_cast<int>(std::floor(std::atan2(ray.y(), ray.x()) / kCell_rad)),
                    static_cast<int>(std::floor(elevation / kCell_rad))});
    }
    seen.push_back(cells.size());
  }
  EXPECT_NEAR(low, kLivoxLow_rad, 1e-3);
  EXPECT_NEAR(high, kLivoxHigh_rad, 1e-3);
  constexpr std::size_t kCells = 120 * 21;
  EXPECT_GT(seen[0], kCells * 6 / 10);    // a tenth of a second leaves gaps
  EXPECT_GT(seen[4], seen[0] * 12 / 10);  // which the next ones fill
  EXPECT_GT(seen[4], kCells * 95 / 100);
}

TEST(SimulatedLivox, BytesDependOnTheSeedAndNotOnTheNumberOfWorkers) {
  LidarRig rig(0.4);
  const TemporaryFolder folder;
  std::vector<std::string> captures;
  for (const unsigned workers : {1U, 3U}) {
    ASSERT_TRUE(write_livox(rig.context, LivoxConfig{}, folder.path(), {.threads = workers}).ok());
    captures.push_back(read_file(folder / "lidar0.pcap"));
  }
  EXPECT_EQ(captures[0], captures[1]);
  rig.context.seed = 8;
  ASSERT_TRUE(write_livox(rig.context, LivoxConfig{}, folder.path()).ok());
  EXPECT_NE(captures[0], read_file(folder / "lidar0.pcap"));
}

TEST(SimulatedLivox, ImuFeelsGravityAtRest) {
  const LidarRig rig(1.0, {}, hall(), false);
  const Decoded d = decoded(rig, exact_config());
  const auto datagrams = d.capture.to(kImu);
  ASSERT_EQ(datagrams.size(), 200U);
  LivoxPacketParser parser(kMid360Lines);
  LivoxPacket packet;
  for (std::size_t i = 0; i < datagrams.size(); ++i) {
    ASSERT_TRUE(parser.parse(datagrams[i]->bytes, packet));
    ASSERT_TRUE(packet.is_imu());
    EXPECT_EQ(static_cast<std::int64_t>(packet.timestamp_ns), rig.context.rig_time(static_cast<double>(i) / 200).ns());
    EXPECT_LT((packet.imu().accel_mps2 - Eigen::Vector3d(0, 0, kGravity_mps2)).norm(), 1e-5);
  }
}

TEST(SimulatedLivox, ScansOfAGenericFolderAreThePoints) {
  const LidarRig rig(0.2);
  const TemporaryFolder folder;
  const auto log = write_livox(rig.context, exact_config(), folder.path(), {.form = LidarForm::kScans});
  ASSERT_TRUE(log.ok());
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "lidar0" / "000000.bin"), 209U * 96 * 5 * sizeof(float));
  EXPECT_EQ(read_file(folder.path() / "lidar0" / "times.txt"), "1767268800.000000000\n1767268800.100320000\n");
}

// Faults: what the log says was done is what a driver counts.

Decoded written_with(const FaultPlan& plan, double duration_s = 1, LivoxConfig config = exact_config()) {
  return decoded(LidarRig(duration_s, plan, hall(), false), config);
}

TEST(SimulatedLivoxFault, LostRepeatedAndOvertakenDatagrams) {
  const Decoded lost = written_with(faulty("loss", 0.2, 0.8, 0.1));
  EXPECT_GT(lost.log.lost, 80U);
  EXPECT_EQ(lost.sweep_counts.missing_packets, lost.log.lost);
  EXPECT_EQ(lost.counts.packets, lost.log.datagrams);
  const Decoded twice = written_with(faulty("duplicate", 0, 9, 0.1));
  EXPECT_GT(twice.log.duplicated, 150U);
  EXPECT_EQ(twice.sweep_counts.repeated_packets, twice.log.duplicated);
  const Decoded overtaken = written_with(faulty("reorder", 0, 9, 0.1));
  EXPECT_GT(overtaken.log.reordered, 150U);
  EXPECT_EQ(overtaken.sweep_counts.missing_packets, 0U);
}

TEST(SimulatedLivoxFault, OffAndRestart) {
  const Decoded off = written_with(faulty("off", 0.25, 0.65));
  EXPECT_GT(off.log.silenced, 800U);
  EXPECT_EQ(off.sweep_counts.missing_packets, off.log.silenced);
  LivoxConfig own_clock = exact_config();
  own_clock.clock_source = "NONE";
  const Decoded restart = written_with(faulty("restart", 0.25, 0.65), 1, own_clock);
  EXPECT_EQ(restart.sweep_counts.missing_packets, 0U);
  EXPECT_LT(restart.sweeps.back().end.seconds(), 1.0);  // the clock began anew, at 0.25 s
  EXPECT_GT(restart.sweeps.front().begin.seconds(), 59.0);
}

TEST(SimulatedLivoxFault, SweepsWithoutPointsOrRangesOrInOnePlaceOrCoarse) {
  const Decoded empty = written_with(faulty("empty", 0.15, 0.25));
  EXPECT_EQ(empty.log.emptied, 208U);
  EXPECT_EQ(empty.counts.bad_count, empty.log.emptied);
  const Decoded zero = written_with(faulty("zero", 0.15, 0.25));
  EXPECT_EQ(zero.sweep_counts.no_return, 208U * 96);
  const Decoded voxel = written_with(faulty("one_voxel", 0, 9), 0.1);
  Eigen::AlignedBox3f box;
  for (const LidarPoint& p : voxel.last_points) box.extend(Eigen::Vector3f(p.x_m, p.y_m, p.z_m));
  EXPECT_LT(box.sizes().maxCoeff(), 0.51F);
  EXPECT_GT(box.min().x(), kMid360Returns.range_min_m) << "beyond the blind zone";
  EXPECT_EQ(voxel.log.returns, voxel.log.shots);
  LivoxConfig blind = exact_config();
  blind.returns.range_max_m = 1;  // sees nothing
  const Decoded full = written_with(faulty("max_points", 0, 9), 0.1, blind);
  EXPECT_EQ(full.log.returns, full.log.shots);
  const Decoded coarse = written_with(faulty("profile", 0, 9), 0.1);
  EXPECT_EQ(coarse.log.other_profile, coarse.counts.packets);
  const LidarPoint& p = coarse.last_points.front();
  EXPECT_NEAR(p.x_m * 100, std::round(p.x_m * 100), 1e-3);
}

}  // namespace
}  // namespace lxd::test::simulator_livox_test
