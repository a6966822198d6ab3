// SPDX-License-Identifier: Apache-2.0
// GNSS through the program: fixes move path, mesh and cloud; without them nothing moves; threads change no byte.
#include <sstream>
#include <string>

#include "tests/support/replay_files.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::gnss_replay_test {
namespace {

namespace fs = std::filesystem;

// A car on a street, in motion from the first instant; small sensors, RTK whose axes are not the world's.
constexpr const char* kCar = R"yaml(
world: street
motion: {carrier: car, start: moving}
duration_s: 10
lidar0: {model: ouster, product: OS1, beams: 32, columns: 1024, T_body_sensor: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.8], [0, 0, 0, 1]]}
imu: {protocol: vectornav, update_rate: 200}
gnss: {rate_hz: 10, antenna_in_reference_m: [-0.3, 0, 1.0], enu_yaw_rad: 0.6, blocked_no_rtk: 0.9, blocked_no_fix: 0.95}
)yaml";
constexpr double kHalfFix_s = 0.05;
constexpr std::array kMoved{"trajectory.tum", "mesh.ply", "cloud.ply"};

class GnssReplay : public testing::Test {
 protected:
  fs::path simulated(const std::string& options = "") {
    write_file(folder_ / "scenario.yaml", kCar);
    const Ended ended = lxd_slam(fmt::format("simulate {} {} --out {}", (folder_ / "scenario.yaml").string(), options,
                                             (folder_ / "recording").string()));
    EXPECT_EQ(ended.status, 0) << ended.text;
    return folder_ / "recording";
  }
  // A log without what came in the part of its sentences from `begin` on, up to `end`.
  static void cut(const fs::path& log, double begin, double end) {
    std::istringstream sentences(read_file(log));
    std::string kept, line;
    double first_s = 0;
    while (std::getline(sentences, line)) {
      const double s = std::stod(line);
      if (first_s == 0) first_s = s;
      if (s - first_s < begin || s - first_s >= end) kept += line + "\n";
    }
    write_file(log, kept);
  }
  TemporaryFolder folder_;
};

TEST_F(GnssReplay, FixesMoveWhatIsWrittenAndNothingElseDoes) {
  const fs::path recording = simulated();
  const RunResult without = replayed(recording, folder_, "--sensors LI", "without");
  const RunResult with = replayed(recording, folder_, "--sensors LIG", "with");
  EXPECT_EQ(without.bytes("trajectory.tum"), without.bytes("odometry.tum"));
  EXPECT_EQ(with.bytes("odometry.tum"), without.bytes("odometry.tum"));  // the filter hears nothing of it
  for (const char* const name : kMoved) {
    EXPECT_EQ(with.bytes(name).size() > 0, true) << name;
    EXPECT_NE(with.bytes(name), without.bytes(name)) << name;
  }
  const auto report = with.report();
  EXPECT_GT(report["gnss"]["used"], 20);
  EXPECT_GT(report["graph"]["key_frames"], 30);
  EXPECT_EQ(without.report()["gnss"]["used"], 0);
  const auto archive = Archive::open(with / "map.db");
  ASSERT_TRUE(archive.ok());
  const auto poses = archive->poses();
  ASSERT_TRUE(poses.ok());
  EXPECT_LT((poses->back().T.p - with.path("trajectory.tum").back().T.p).norm(), 1e-8);
}

TEST_F(GnssReplay, ThreadsChangeNoByte) {
  const fs::path recording = simulated();
  const RunResult one = replayed(recording, folder_, "--sensors LIG --set threads=1", "one");
  const RunResult two = replayed(recording, folder_, "--sensors LIG --set threads=2", "two");
  for (const char* const name : kMoved) EXPECT_TRUE(one.bytes(name) == two.bytes(name)) << name;
}

TEST_F(GnssReplay, AJumpIsRefusedAndCounted) {
  const fs::path recording = simulated("--fault gnss_jump@7+2");
  const RunResult run = replayed(recording, folder_, "--sensors LIG", "jump");
  EXPECT_GT(run.report()["rejected"]["gnss"]["jumped"], 5);
  EXPECT_FALSE(run.report()["rejected"]["gnss"].contains("outlying")) << "believed at first";
  const auto ended = evaluated(
      fmt::format("--estimate {} --truth {}", (run / "trajectory.tum").string(), (recording / "truth.tum").string()));
  EXPECT_LT(static_cast<double>(ended["ate_m"]["rmse"]), 0.05);

  cut(recording / "gnss.nmea", 7 - kHalfFix_s, 9 - kHalfFix_s);
  const RunResult witness = replayed(recording, folder_, "--sensors LIG", "witness");
  EXPECT_FALSE(witness.report()["rejected"].contains("gnss"));
  EXPECT_TRUE(run.bytes("trajectory.tum") == witness.bytes("trajectory.tum")) << "as if those fixes had not been";
}

}  // namespace
}  // namespace lxd::test::gnss_replay_test
