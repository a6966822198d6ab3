// SPDX-License-Identifier: Apache-2.0
// Input that is wrong as a whole is refused before anything is made: status 2, a message that names file, key or line,
// what was found and what was wanted, and no run's folder.
#include "tests/support/room_recording.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::refused_input_test {
namespace {

constexpr int kBadInput = 2, kFailed = 1;

class RefusedInput : public testing::Test {
 protected:
  // Replays and expects the refusal.
  void expect_refused(const std::filesystem::path& recording, const std::vector<std::string>& said,
                      const std::string& options = "") {
    const Ended ended = lxd_slam(fmt::format("replay {} {} --out {}", recording.string(), options, out().string()));
    EXPECT_EQ(ended.status, kBadInput) << ended.text;
    for (const std::string& part : said) EXPECT_TRUE(ended.says(part)) << "wanted: " << part << "\n" << ended.text;
    EXPECT_FALSE(std::filesystem::exists(out()));
  }
  void expect_rig_refused(const std::string& rig, const std::vector<std::string>& said) {
    const RoomRecording room(1);
    write_file(room.path() / "rig.yaml", rig);
    expect_refused(room.path(), said);
    write_file(folder_ / "other.yaml", rig);
    std::filesystem::remove(room.path() / "rig.yaml");
    expect_refused(room.path(), {"other.yaml"}, "--rig " + (folder_ / "other.yaml").string());
  }
  [[nodiscard]] std::filesystem::path out() const { return folder_ / "run"; }

  TemporaryFolder folder_;
};

TEST_F(RefusedInput, UnknownKeyOfTheRigFileIsNamedWithItsLine) {
  expect_rig_refused("reference: lidar0\nlidar0:\n  beems: 16\n",
                     {"rig.yaml:3: lidar0.beems: unknown key", "did you mean beams"});
}

TEST_F(RefusedInput, WrongUnitInTheRigFileIsNamedWithItsLine) {
  expect_rig_refused("reference: lidar0\nlidar0: {range_m: [500, 80000]}\n",
                     {"rig.yaml:2: lidar0.range_m[1]: found 80000", "millimetres"});
}

TEST_F(RefusedInput, EveryFaultOfTheRigFileIsToldAtOnce) {
  expect_rig_refused("reference: lidar0\nlidar0: {beems: 16, rate_hz: -1}\n", {"lidar0.beems", "lidar0.rate_hz"});
}

TEST_F(RefusedInput, FolderOfAnotherKindSaysWhatWasFoundAndWhatIsRead) {
  std::filesystem::create_directories(folder_ / "photos");
  write_file(folder_ / "photos/holiday.jpg", "x");
  expect_refused(folder_ / "photos", {"holiday.jpg", "velodyne_points/", "velodyne/", "lidar0/", ".pcap"});
}

TEST_F(RefusedInput, FileOfAnotherKindSaysSo) {
  write_file(folder_ / "notes.pcap", "not a capture");
  expect_refused(folder_ / "notes.pcap", {"notes.pcap", "no packet capture"});
}

TEST_F(RefusedInput, RecordingThatIsNotThereSaysSo) {
  expect_refused(folder_ / "nothing", {"nothing: no such file or folder"});
}

class RefusedTimes : public RefusedInput, public testing::WithParamInterface<replay_test::LayoutCase> {
 protected:
  void SetUp() override {
    layout_ = GetParam().make();
    layout_->good_scan(0);
    layout_->times({1});
  }
  std::unique_ptr<replay_test::ReplayLayout> layout_;
};

TEST_P(RefusedTimes, LineThatIsNoTimeIsNamed) {
  write_file(layout_->times_file(), "yesterday\n");
  expect_refused(layout_->path(), {layout_->times_file().string() + ": line 1: found \"yesterday\""});
}

TEST_P(RefusedTimes, MissingFileIsNamed) {
  std::filesystem::remove(layout_->times_file());
  expect_refused(layout_->path(), {layout_->times_file().string() + ": cannot be read"});
}

TEST_P(RefusedTimes, FolderInItsPlaceIsNamed) {
  std::filesystem::remove(layout_->times_file());
  std::filesystem::create_directory(layout_->times_file());
  expect_refused(layout_->path(), {layout_->times_file().string() + ": cannot be read"});
}

TEST_P(RefusedTimes, EmptyFileIsNamed) {
  write_file(layout_->times_file(), "");
  expect_refused(layout_->path(), {layout_->times_file().string() + ": found no time stamp"});
}

INSTANTIATE_TEST_SUITE_P(Kinds, RefusedTimes, testing::ValuesIn(replay_test::every_layout()),
                         [](const auto& param) { return replay_test::letters_of(param.param.kind); });

// Given scans of which none is one, when replayed, then that is a failure and not an empty success.
TEST(UnusableRecording, FailsAndSaysWhyNoSweepWasTaken) {
  replay_test::GenericLayout layout;
  for (int i = 0; i < 3; ++i) layout.scan(i, {{0, 0, 0, 0}});
  layout.times({1, 1.1, 1.2});
  const TemporaryFolder folder;
  const Ended ended = lxd_slam(fmt::format("replay {} --out {}", layout.path().string(), (folder / "run").string()));
  EXPECT_EQ(ended.status, kFailed);
  EXPECT_TRUE(ended.says("found no sweep that could be used")) << ended.text;
  EXPECT_TRUE(ended.says("empty_sweep 3")) << ended.text;
  EXPECT_EQ(RunResult(folder / "run").report()["rejected"]["generic"]["empty_sweep"], 3);
}

}  // namespace
}  // namespace lxd::test::refused_input_test
