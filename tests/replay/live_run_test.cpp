// SPDX-License-Identifier: Apache-2.0
// `lxd-slam run` against a recording that is played onto real wires: it goes the way that a replay goes, through silent
// sensors and pulled cables, and leaves a whole run.
#include <csignal>

#include "drivers/device/host_clock.hpp"
#include "drivers/device/udp_socket.hpp"
#include "tests/support/emulated.hpp"
#include "tests/support/run_result.hpp"
#include "tests/support/wire_player.hpp"

namespace lxd::test::live_run_test {
namespace {

namespace fs = std::filesystem;

// Slow and sparse, so that a busy machine keeps up.
constexpr const char* kSmallRig = R"yaml(
world: building
motion: {carrier: handheld, rest_s: 1, vigour: 0.3}
lidar0: {model: ouster, product: OS0, beams: 32, columns: 512}
imu: {protocol: vectornav, update_rate: 200}
gnss: {rate_hz: 5}
)yaml";

constexpr double kEverything_s = 1e9;
constexpr double kSameWay_m = 0.1;      // sweeps that a busy machine drops cost a little
constexpr double kBlindSecond_m = 0.5;  // by an IMU alone that was away itself a second before

class LiveRun : public testing::Test {
 protected:
  void SetUp() override {
    if (emulated()) GTEST_SKIP() << kNoSerialLine;
    write_file(folder_ / "scenario.yaml", kSmallRig);
    const Ended made = lxd_slam(fmt::format("simulate {} --duration {} --out {}", (folder_ / "scenario.yaml").string(),
                                            duration_s(), original_.string()));
    EXPECT_EQ(made.status, 0) << made.text;
    player_.emplace(original_, folder_);
  }

  [[nodiscard]] virtual int duration_s() const { return 8; }
  [[nodiscard]] std::string command() const {
    return fmt::format("run --rig {} --out {}", player_->rig_file().string(), run_.string());
  }
  // Whether the program listens: the run's last file is there, and the devices are opened right after.
  void wait_until_it_listens() {
    for (int i = 0; i < 3000 && !exists(run_ / "rig.yaml"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    shift_ = clock_.now() - player_->first();
  }
  // All that was recorded, at its own pace, and then Ctrl-C.
  Ended run_to_the_end(Program& program) {
    wait_until_it_listens();
    player_->play(0, kEverything_s);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    program.signal(SIGINT);
    return program.wait();
  }

  TemporaryFolder folder_;
  fs::path original_ = folder_ / "original", run_ = folder_ / "live";
  std::optional<WirePlayer> player_;
  HostClock clock_;
  Duration shift_;  // from the recording's time to the host's, when it is played
};

bool tells(const nlohmann::json& report, const std::string& source, const std::string& what) {
  for (const auto& event : report["live"]["events"])
    if (event["source"] == source && event["what"].get<std::string>().starts_with(what)) return true;
  return false;
}

// The farthest that a path is off another's line, whose clock is behind by `shift`.
double farthest_m(const std::vector<StampedPose>& path, const std::vector<StampedPose>& line, Duration shift) {
  double farthest = 0;
  for (const StampedPose& pose : path) {
    const RigTime t = pose.stamp - shift;
    const auto after = std::ranges::lower_bound(line, t, {}, &StampedPose::stamp);
    if (after == line.begin() || after == line.end()) continue;
    const StampedPose &to = *after, &from = *std::prev(after);
    const double share = (t - from.stamp).seconds() / (to.stamp - from.stamp).seconds();
    farthest = std::max(farthest, (pose.T.p - from.T.p - share * (to.T.p - from.T.p)).norm());
  }
  return farthest;
}

// Given a rig's bytes on its wires at their own pace, when it is run and stopped, then the path is that of a replay,
// and every file of a run is there.
TEST_F(LiveRun, GoesTheWayThatAReplayGoes) {
  Program program(command());
  const Ended ended = run_to_the_end(program);
  ASSERT_EQ(ended.status, 0) << ended.text;
  const RunResult live(run_);
  const RunResult replay = replayed(original_, folder_, "");
  ASSERT_GT(live.path().size(), replay.path().size() / 2) << ended.text;
  EXPECT_LT(farthest_m(live.path(), replay.path(), shift_), kSameWay_m) << ended.text;
  RecordProperty("farthest_mm", static_cast<int>(1000 * farthest_m(live.path(), replay.path(), shift_)));
  EXPECT_GT(live.faces(), 1000U);
  const auto report = live.report();
  EXPECT_EQ(report["interrupted"], true);
  EXPECT_TRUE(tells(report, "lidar0", "heard"));
  EXPECT_TRUE(tells(report, "imu", "heard"));
  EXPECT_TRUE(tells(report, "gnss", "heard"));
  EXPECT_EQ(report["live"]["devices"][(folder_ / "imu").string()]["bytes"], player_->sent_bytes("imu"));
}

// Long enough to see two places of the map.
class LiveRunInAMap : public LiveRun {
 protected:
  [[nodiscard]] int duration_s() const override { return 16; }
};

// Given the map of an earlier session, when a rig is run in it, then it finds its place there while it runs, and its
// path is in that map's frame.
TEST_F(LiveRunInAMap, FindsItsPlace) {
  const RunResult earlier = replayed(original_, folder_, "", "earlier");
  Program program(command() + fmt::format(" --localise --map {}", (folder_ / "earlier/map.db").string()));
  const Ended ended = run_to_the_end(program);
  ASSERT_EQ(ended.status, 0) << ended.text;
  const RunResult live(run_);
  const auto map = live.report()["map"];
  ASSERT_TRUE(map["relocalised"]) << live.report();
  EXPECT_EQ(map["pieces_apart"], 0);
  EXPECT_LT(farthest_m(live.path("trajectory.tum"), earlier.path("trajectory.tum"), shift_), kSameWay_m);
}

// The pose of a datagram (board/pose_message.hpp).
struct ToldPose {
  double t_s;
  Eigen::Vector3d p;
};

ToldPose told_pose(const std::string& datagram) {
  std::int64_t t_ns = 0;
  Eigen::Vector3d p;
  std::memcpy(&t_ns, datagram.data() + 16, sizeof(t_ns));
  std::memcpy(p.data(), datagram.data() + 32, 3 * sizeof(double));
  return {RigTime::from_ns(t_ns).seconds(), p};
}

// Given a controller that wants to be told, when the rig runs, then it hears a pose for every reading of the IMU, and
// at the sweeps these are the poses that the run publishes afterwards.
TEST_F(LiveRun, TellsItsPoseAtEveryReadingOfTheImu) {
  constexpr double kReadings_hz = 200, kBegun_s = 2;
  const auto controller = UdpSocket::open({.sources = {{}}}, clock_);
  ASSERT_TRUE(controller);
  Program program(fmt::format("{} --poses 127.0.0.1:{}", command(), (*controller)->port()));
  const Ended ended = run_to_the_end(program);
  ASSERT_EQ(ended.status, 0) << ended.text;
  KeepChunks kept;
  while (readable(**controller, std::chrono::milliseconds(0))) (*controller)->read(kept);
  const RunResult live(run_);
  EXPECT_EQ(live.report()["live"]["poses"]["sent"], kept.chunks.size());
  const double told_s = static_cast<double>(kept.chunks.size()) / kReadings_hz;
  EXPECT_GT(told_s, live.report()["duration_s"].get<double>() - kBegun_s) << ended.text;
  std::size_t met = 0;
  for (const StampedPose& pose : live.path()) {
    for (const KeepChunks::Kept& chunk : kept.chunks) {
      const ToldPose told = told_pose(chunk.text);
      if (std::abs(told.t_s - pose.stamp.seconds()) > 0.5 / kReadings_hz) continue;
      ++met;
      EXPECT_LT((told.p - pose.T.p).norm(), kSameWay_m) << told.t_s;
    }
  }
  EXPECT_GT(met, live.path().size() / 2);
}

// Given an IMU whose cable is pulled and a LiDAR that is silent for a while, then both are told, and the path goes on
// when they are back.
TEST_F(LiveRun, GoesOnWhenSensorsComeBack) {
  Program program(command() + " --quiet");
  wait_until_it_listens();
  player_->play(0, 3);
  player_->imu().pull();
  player_->play(3, 4);
  player_->imu().plug();
  player_->play(4, 5);
  player_->play(5, 6, 1, [](const PlayedBytes& piece, double) { return piece.wire != "lidar0"; });
  player_->play(6, kEverything_s);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  program.signal(SIGTERM);
  const Ended ended = program.wait();
  ASSERT_EQ(ended.status, 0) << ended.text;
  const RunResult live(run_);
  const auto report = live.report();
  EXPECT_TRUE(tells(report, (folder_ / "imu").string(), "away"));
  EXPECT_TRUE(tells(report, (folder_ / "imu").string(), "back"));
  EXPECT_TRUE(tells(report, "imu", "silent"));
  EXPECT_TRUE(tells(report, "imu", "heard again"));
  EXPECT_TRUE(tells(report, "lidar0", "silent"));
  EXPECT_TRUE(tells(report, "lidar0", "heard again"));
  std::vector<StampedPose> path = live.path();
  const std::vector<StampedPose> line = replayed(original_, folder_, "").path();
  EXPECT_LT(farthest_m(path, line, shift_), kBlindSecond_m) << ended.text;
  std::erase_if(path, [&](const StampedPose& pose) {
    const double t_s = (pose.stamp - shift_ - player_->first()).seconds();
    return t_s > 5 && t_s < 6.1;
  });
  EXPECT_LT(farthest_m(path, line, shift_), kSameWay_m) << ended.text;
}

// Given a rig whose IMU is the one inside the LiDAR, then its packets, on a port of their own, carry the path.
TEST_F(LiveRun, GoesByTheImuInsideTheLidar) {
  player_->change([](Rig& rig) {
    rig.imu->protocol = kLidarImuProtocol;
    rig.imu->wire.device.clear();
  });
  Program program(command());
  const Ended ended = run_to_the_end(program);
  ASSERT_EQ(ended.status, 0) << ended.text;
  EXPECT_TRUE(ended.says(": LIG, ")) << ended.text;
  const RunResult replay = replayed(original_, folder_, "--rig " + player_->rig_file().string());
  EXPECT_LT(farthest_m(RunResult(run_).path(), replay.path(), shift_), kSameWay_m) << ended.text;
}

TEST_F(LiveRun, SaysWhatTheRigFileLacks) {
  const Ended ended = lxd_slam(fmt::format("run --rig {} --out {}", (original_ / "rig.yaml").string(), run_.string()));
  EXPECT_EQ(ended.status, 2);
  EXPECT_TRUE(ended.says("lidar0.metadata: found nothing")) << ended.text;
  EXPECT_FALSE(exists(run_));
}

// Given a rig of which nothing is heard, then the run ends when it is told to, and says that it has nothing.
TEST_F(LiveRun, OfASilentRigIsNoSuccess) {
  const Ended ended = lxd_slam(command() + " --duration 0.5");
  EXPECT_EQ(ended.status, 1);
  EXPECT_TRUE(ended.says("found no sweep that could be used")) << ended.text;
}

}  // namespace
}  // namespace lxd::test::live_run_test
