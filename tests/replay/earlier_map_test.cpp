// SPDX-License-Identifier: Apache-2.0
// A second session in the hall of the first: it finds where it is, goes on with the map or only says where it is in it.
#include "tests/support/room_recording.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::earlier_map_test {
namespace {

constexpr int kBadInput = 2;

class SecondSession : public ::testing::Test {
 protected:
  // The first session sees all; the second begins two seconds later, three metres on, and knows nothing of the first.
  [[nodiscard]] RunResult first() const { return replayed(boxroom() / "moving", folder_, "--sensors L", "old"); }
  [[nodiscard]] RunResult second(const std::string& options) const {
    return replayed(
        boxroom() / "moving", folder_,
        fmt::format("--sensors L --mute lidar0@0+2 --map {} {}", (folder_ / "old/map.db").string(), options), "new");
  }
  // Between the same instants of two runs, each in the frame that it says.
  static double apart_m(const RunResult& a, const RunResult& b, const std::string& file_of_b = "trajectory.tum") {
    double worst = 0;
    for (const StampedPose& pose : b.path(file_of_b))
      for (const StampedPose& same : a.path("trajectory.tum"))
        if (same.stamp == pose.stamp) worst = std::max(worst, (same.T.p - pose.T.p).norm());
    return worst;
  }

  TemporaryFolder folder_;
};

TEST_F(SecondSession, IsInTheFrameOfTheFirstAndGoesOnWithItsMap) {
  const RunResult old = first();
  const std::string before = old.bytes("map.db");
  const RunResult run = second("");
  const auto map = run.report()["map"];
  ASSERT_TRUE(map["relocalised"]) << run.report();
  EXPECT_GE(map["places"], 2);
  EXPECT_EQ(map["pieces_apart"], 0);
  EXPECT_GT(apart_m(old, run, "odometry.tum"), 1.0) << "by itself it has a frame of its own";
  EXPECT_LT(apart_m(old, run), 0.05);

  const auto one = Archive::open(old / "map.db"), both = Archive::open(run / "map.db");
  EXPECT_GT(both->totals().submeshes, one->totals().submeshes);
  EXPECT_EQ(both->totals().sessions, 2);
  EXPECT_EQ(both->poses(0)->size(), one->poses()->size());
  EXPECT_EQ(both->poses()->size(), run.path("trajectory.tum").size());
  EXPECT_GT(run.faces(), old.faces());
  EXPECT_GT(both->totals().faces, 1.8 * static_cast<double>(old.faces()));
  EXPECT_LT(run.faces(), 1.2 * static_cast<double>(old.faces())) << "both show the same hall: it has one layer";
  EXPECT_EQ(old.bytes("map.db"), before) << "the first session's map is read, never written";
}

TEST_F(SecondSession, OnlyLocalisesWhenAsked) {
  const RunResult old = first();
  const RunResult run = second("--localise");
  EXPECT_TRUE(run.report()["map"]["relocalised"]);
  EXPECT_LT(apart_m(old, run), 0.05);
  EXPECT_EQ(Archive::open(run / "map.db")->totals().submeshes, 0U);
  EXPECT_EQ(Archive::open(run / "map.db")->poses()->size(), run.path("trajectory.tum").size());
  for (const char* const file : {"mesh.ply", "cloud.ply", "overview.png"}) EXPECT_FALSE(exists(run / file)) << file;
}

// The graph's own thread, or none: the same bytes.
TEST_F(SecondSession, GivesTheSameBytesHoweverManyThreads) {
  const RunResult old = first();
  const std::string one = second("--set threads=1").bytes("trajectory.tum");
  EXPECT_EQ(second("--set threads=2").bytes("trajectory.tum"), one);
}

TEST_F(SecondSession, ThatIsElsewhereSaysSoAndKeepsItsFrame) {
  const RunResult old = first();
  const RoomRecording room(5);
  const Ended ended = lxd_slam(fmt::format("replay {} --map {} --out {}", room.path().string(),
                                           (old / "map.db").string(), (folder_ / "new").string()));
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_TRUE(ended.says("note: never found in ")) << ended.text;
  const RunResult run(folder_ / "new");
  EXPECT_FALSE(run.report()["map"]["relocalised"]);
  EXPECT_TRUE(run.report()["map"]["relocalised_t"].is_null());
  EXPECT_EQ(run.bytes("trajectory.tum"), run.bytes("odometry.tum"));
  EXPECT_EQ(Archive::open(run / "map.db")->totals().submeshes, 1U) << "nothing was merged";
}

// Each is refused before anything is written, with the file and the cause.
TEST_F(SecondSession, WhatIsNoMapIsRefused) {
  const RunResult old = first();
  const RoomRecording room(2);
  const auto refused = [&](const std::string& options, const std::string& out, const std::string& cause) {
    const Ended ended =
        lxd_slam(fmt::format("replay {} {} --out {}", room.path().string(), options, (folder_ / out).string()));
    EXPECT_EQ(ended.status, kBadInput) << ended.text;
    EXPECT_TRUE(ended.says(cause)) << ended.text;
    EXPECT_TRUE(out == "old" || !exists(folder_ / out)) << out;
  };
  const std::string map = (old / "map.db").string();
  refused("--localise", "new", "--localise requires --map");
  refused("--map " + (folder_ / "none.db").string(), "new", "none.db: cannot be read: No such file");
  refused("--map " + (room.path() / "lidar0/times.txt").string(), "new", "not a map archive");
  refused("--map " + map, "old", "wanted another one for this run");
  std::string bytes = old.bytes("map.db");
  write_file(folder_ / "half.db", bytes.substr(0, bytes.size() / 2));
  refused("--map " + (folder_ / "half.db").string(), "new", "half.db: truncated");
  bytes[63] = 1;  // user_version, big-endian
  write_file(folder_ / "old.db", bytes);
  refused("--map " + (folder_ / "old.db").string(), "new", "archive version 1, this program reads version 2");
  EXPECT_TRUE(Archive::open(old / "map.db").ok());
}

}  // namespace
}  // namespace lxd::test::earlier_map_test
