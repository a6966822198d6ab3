// SPDX-License-Identifier: Apache-2.0
// A recording that a tool writes appears whole or not at all, and never in place of something else.
#include <fstream>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "drivers/replay/unfinished_recording.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/recording_folder.hpp"
#include "tools/simulator/simulation_file.hpp"

namespace lxd::tools_recording_folder_test {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file) { std::ofstream(file) << "x"; }

class RecordingFolderStory : public testing::Test {
 protected:
  test::TemporaryFolder temporary_;
  fs::path out_ = temporary_.path() / "made" / "recording";
};

TEST_F(RecordingFolderStory, IsNotThereBeforeItIsCommitted) {
  auto folder = RecordingFolder::create(out_, 0, sim::kSimulatedRecording);
  ASSERT_TRUE(folder) << folder.error().message;
  write(folder->path() / "lidar0.pcap");
  EXPECT_FALSE(fs::exists(out_));
  ASSERT_TRUE(folder->commit());
  EXPECT_TRUE(fs::exists(out_ / "lidar0.pcap"));
}

// A writer that is killed leaves the folder as it is now, under a name that a user may change.
TEST_F(RecordingFolderStory, IsMarkedAsUnfinishedUntilItIsCommitted) {
  auto folder = RecordingFolder::create(out_, 0, sim::kSimulatedRecording);
  ASSERT_TRUE(folder) << folder.error().message;
  EXPECT_TRUE(is_unfinished(folder->path()));
  write(folder->path() / sim::kSimulationFile);
  ASSERT_TRUE(folder->commit());
  EXPECT_FALSE(is_unfinished(out_));
  EXPECT_FALSE(fs::exists(out_ / kUnfinishedMark));
}

TEST_F(RecordingFolderStory, LeavesNothingWhenItIsGivenUp) {
  {
    auto folder = RecordingFolder::create(out_, 0, sim::kSimulatedRecording);
    ASSERT_TRUE(folder);
    write(folder->path() / "lidar0.pcap");
  }
  EXPECT_TRUE(fs::is_empty(out_.parent_path()));
}

TEST_F(RecordingFolderStory, ReplacesAnEarlierSimulationOnly) {
  fs::create_directories(out_);
  write(out_ / sim::kSimulationFile);
  write(out_ / "lidar1.pcap");
  auto again = RecordingFolder::create(out_, 0, sim::kSimulatedRecording);
  ASSERT_TRUE(again) << again.error().message;
  ASSERT_TRUE(again->commit());
  EXPECT_FALSE(fs::exists(out_ / "lidar1.pcap"));

  write(out_ / sim::kSimulationFile);
  write(out_ / "thesis.tex");  // that a user put beside it
  const auto refused = RecordingFolder::create(out_, 0, sim::kSimulatedRecording);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("holds something else"), std::string::npos) << refused.error().message;
  EXPECT_TRUE(fs::exists(out_ / "thesis.tex"));
}

TEST_F(RecordingFolderStory, OfTwoAtTheSamePlaceTheLastIsWhole) {
  auto one = RecordingFolder::create(out_, 0, sim::kSimulatedRecording);
  auto two = RecordingFolder::create(out_, 0, sim::kSimulatedRecording);
  ASSERT_TRUE(one && two);
  EXPECT_NE(one->path(), two->path());
  for (auto* const folder : {&*two, &*one}) {
    write(folder->path() / sim::kSimulationFile);
    write(folder->path() / (folder == &*one ? "lidar0.pcap" : "lidar1.pcap"));
    ASSERT_TRUE(folder->commit());
  }
  EXPECT_TRUE(fs::exists(out_ / "lidar0.pcap"));
  EXPECT_FALSE(fs::exists(out_ / "lidar1.pcap"));
}

TEST_F(RecordingFolderStory, WithoutRoomIsRefusedBeforeWorkBegins) {
  const auto refused =
      RecordingFolder::create(out_, std::numeric_limits<std::uint64_t>::max(), sim::kSimulatedRecording);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("free space"), std::string::npos) << refused.error().message;
  EXPECT_TRUE(fs::is_empty(out_.parent_path()));
}

TEST_F(RecordingFolderStory, BelowAFileCannotBeMade) {
  write(temporary_.path() / "file");
  const auto refused = RecordingFolder::create(temporary_.path() / "file" / "recording", 0, sim::kSimulatedRecording);
  ASSERT_FALSE(refused);
}

}  // namespace
}  // namespace lxd::tools_recording_folder_test
