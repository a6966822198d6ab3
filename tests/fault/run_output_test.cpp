// SPDX-License-Identifier: Apache-2.0
// Where a run cannot be written, or its disk fills up: told with the file's name, and what was there before stays.
#include "tests/support/room_recording.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::run_output_test {
namespace {

constexpr int kFailed = 1, kBadInput = 2;

Ended replay_into(const std::filesystem::path& recording, const std::filesystem::path& out,
                  const ProgramLimits& limits = {}) {
  return lxd_slam(fmt::format("replay {} --out {}", recording.string(), out.string()), limits);
}

TEST(RunOutput, PlaceThatCannotBeAFolderIsRefusedWithItsName) {
  const RoomRecording room(1);
  const TemporaryFolder folder;
  write_file(folder / "file", "precious");
  for (const auto& out : {folder / "file", folder / "file/run", std::filesystem::path("/proc/run")}) {
    const Ended ended = replay_into(room.path(), out);
    EXPECT_EQ(ended.status, kBadInput) << ended.text;
    EXPECT_TRUE(ended.says(out.string() + ": ")) << ended.text;
  }
  EXPECT_EQ(read_file(folder / "file"), "precious");
}

TEST(RunOutput, FolderOfSomethingElseIsLeftAlone) {
  const RoomRecording room(1);
  EXPECT_EQ(replay_into(room.path(), room.path()).status, kBadInput);
  EXPECT_TRUE(std::filesystem::exists(room.file(0)));
}

// An earlier run in which somebody keeps a folder of the archive's name.
TEST(RunOutput, ArchiveThatCannotBeReplacedIsNamed) {
  const RoomRecording room(1);
  const TemporaryFolder folder;
  write_file(folder / "odometry.tum", "");
  std::filesystem::create_directories(folder / "map.db/precious");
  const Ended ended = replay_into(room.path(), folder.path());
  EXPECT_EQ(ended.status, kBadInput) << ended.text;
  EXPECT_TRUE(ended.says((folder / "map.db").string())) << ended.text;
  EXPECT_TRUE(std::filesystem::exists(folder / "map.db/precious"));
}

TEST(RunOutput, DiskThatIsFullFromTheStartIsToldBeforeTheRun) {
  const RoomRecording room(1);
  const TemporaryFolder folder;
  constexpr rlim_t kAlmostNothing_bytes = 100;
  const Ended ended = replay_into(room.path(), folder / "run", {.file_bytes = kAlmostNothing_bytes});
  EXPECT_EQ(ended.status, kBadInput) << ended.text;
  EXPECT_TRUE(ended.says("map.db: ")) << ended.text;
}

// Given a disk that fills up half way, then mapping goes on, it is said once and at which file, and the run is a
// failure in the end; what had room is there.
TEST(RunOutput, DiskThatFillsUpIsSaidOnceAndTheRunGoesOn) {
  constexpr std::size_t kSweeps = 30;
  constexpr rlim_t kRoomForTheMap_bytes = 1'000'000;  // and for none of the cloud
  const RoomRecording room(kSweeps);
  const TemporaryFolder folder;
  const Ended ended = replay_into(room.path(), folder / "run", {.file_bytes = kRoomForTheMap_bytes});
  EXPECT_EQ(ended.status, kFailed) << ended.text;
  const std::string what = (folder / "run/cloud.ply").string() + ": writing failed";
  EXPECT_TRUE(ended.says("note: " + what)) << ended.text;
  EXPECT_EQ(ended.text.find("mapping goes on"), ended.text.rfind("mapping goes on")) << ended.text;

  const RunResult run(folder / "run");
  EXPECT_EQ(run.report()["sweeps"], kSweeps);
  EXPECT_EQ(run.path().size(), kSweeps);
  EXPECT_EQ(run.path("trajectory.tum").size(), kSweeps);
  EXPECT_GT(run.faces(), 1000U);
  const auto archive = Archive::open(run / "map.db");
  ASSERT_TRUE(archive.ok()) << archive.error().message;
  EXPECT_EQ(archive->totals().submeshes, 1U);
}

// What a script reads from standard output must not be cut off unnoticed.
TEST(RunOutput, StandardOutputThatCannotBeWrittenIsAFailure) {
  const RoomRecording room(3);
  const TemporaryFolder folder;
  ASSERT_EQ(replay_into(room.path(), folder / "run").status, 0);
  const std::string path = (folder / "run/odometry.tum").string();
  for (const std::string& command :
       {std::string("budget"), std::string("check --settings"),
        "evaluate --json --estimate " + path + " --truth " + path,
        fmt::format("replay {} --out {}", room.path().string(), (folder / "run").string())}) {
    const Ended ended = lxd_slam(command, {.standard_output = "/dev/full"});
    EXPECT_EQ(ended.status, kFailed) << command;
    EXPECT_TRUE(ended.says("standard output")) << ended.text;
  }
}

// Given a log on a full disk, then the run is not given up for words that nobody can read.
TEST(RunOutput, StandardErrorThatCannotBeWrittenCostsNothing) {
  const RoomRecording room(5);
  const TemporaryFolder folder;
  EXPECT_EQ(replay_into(room.path(), folder / "run", {.standard_error = "/dev/full"}).status, 0);
  EXPECT_EQ(RunResult(folder / "run").path().size(), 5U);
  EXPECT_GT(RunResult(folder / "run").faces(), 1000U);
  EXPECT_EQ(lxd_slam("replay nothing", {.standard_error = "/dev/full"}).status, kBadInput);
}

TEST(RunOutput, ExportThatCannotBeWrittenIsAFailureWithItsName) {
  const RoomRecording room(2);
  const TemporaryFolder folder;
  ASSERT_EQ(replay_into(room.path(), folder / "run").status, 0);
  constexpr rlim_t kAlmostNothing_bytes = 100;
  for (const char* what : {"--mesh", "--cloud", "--trajectory"}) {
    const std::string name = std::string(what) == "--trajectory" ? "out.tum" : "out.ply";
    const std::string command = fmt::format("export {} {} ", (folder / "run").string(), what);
    const Ended nowhere = lxd_slam(command + (folder / "nowhere" / name).string());
    EXPECT_EQ(nowhere.status, kFailed) << nowhere.text;
    EXPECT_TRUE(nowhere.says("nowhere/" + name)) << nowhere.text;
    const Ended full = lxd_slam(command + (folder / name).string(), {.file_bytes = kAlmostNothing_bytes});
    EXPECT_EQ(full.status, kFailed) << full.text;
    EXPECT_TRUE(full.says(name)) << full.text;
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
}

}  // namespace
}  // namespace lxd::test::run_output_test
