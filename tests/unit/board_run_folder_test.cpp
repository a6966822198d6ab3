// SPDX-License-Identifier: Apache-2.0
// A run's folder is made, reused and recognised; nothing that is not a run's is ever touched.
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

#include "board/run_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::board_run_folder_test {
namespace {

namespace fs = std::filesystem;

class BoardRunFolder : public testing::Test {
 protected:
  test::TemporaryFolder temporary_;
  fs::path root_ = temporary_.path();
};

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void touch(const fs::path& path) { std::ofstream(path) << "x"; }

TEST_F(BoardRunFolder, IsMadeWithItsParents) {
  const auto folder = RunFolder::create(root_ / "a" / "b");
  ASSERT_TRUE(folder) << folder.error().message;
  EXPECT_TRUE(fs::is_directory(root_ / "a" / "b"));
  EXPECT_EQ(folder->file(run_files::kReport), root_ / "a" / "b" / "report.json");
}

TEST_F(BoardRunFolder, OfAnEarlierRunIsEmptiedOfTheRunOnly) {
  for (const char* name : {"odometry.tum", "map.db", "map.db-wal", "mesh.ply.part", "errors.png", "notes.txt"})
    touch(root_ / name);
  ASSERT_TRUE(RunFolder::create(root_));
  EXPECT_FALSE(fs::exists(root_ / "odometry.tum"));
  EXPECT_FALSE(fs::exists(root_ / "map.db"));
  EXPECT_FALSE(fs::exists(root_ / "map.db-wal"));
  EXPECT_FALSE(fs::exists(root_ / "mesh.ply.part"));
  EXPECT_FALSE(fs::exists(root_ / "errors.png")) << "of the earlier run's errors";
  EXPECT_TRUE(fs::exists(root_ / "notes.txt"));
}

TEST_F(BoardRunFolder, IsNotMadeOfARecording) {
  for (const char* name : {"rig.yaml", "odometry.tum"}) touch(root_ / name);  // a path of its own, but no map
  fs::create_directory(root_ / "lidar0");
  const auto folder = RunFolder::create(root_);
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().message.find("other than a run"), std::string::npos);
  EXPECT_TRUE(fs::exists(root_ / "rig.yaml"));
}

TEST_F(BoardRunFolder, IsNotMadeOfAFile) {
  touch(root_ / "file");
  EXPECT_FALSE(RunFolder::create(root_ / "file").ok());
  EXPECT_FALSE(RunFolder::create(root_ / "file" / "below").ok());
}

TEST_F(BoardRunFolder, OpensOnlyWhereARunIs) {
  EXPECT_FALSE(RunFolder::open(root_).ok());
  EXPECT_FALSE(RunFolder::open(root_ / "missing").ok());
  touch(root_ / "odometry.tum");
  touch(root_ / "map.db");
  EXPECT_TRUE(RunFolder::open(root_).ok());
}

TEST_F(BoardRunFolder, LinesAreOnDiskAsSoonAsTheyAreAppended) {
  auto file = LineFile::create(root_ / "lines.txt");
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->append("one\n"));
  EXPECT_EQ(content(root_ / "lines.txt"), "one\n");
  ASSERT_TRUE(file->append("two\n"));
  EXPECT_EQ(content(root_ / "lines.txt"), "one\ntwo\n");
}

TEST_F(BoardRunFolder, AFullDiskIsAnErrorWithTheFilesName) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  const Status written = write_text("/dev/full", "text");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/dev/full"), std::string::npos);
  auto file = LineFile::create("/dev/full");
  ASSERT_TRUE(file);
  EXPECT_FALSE(file->append("line\n").ok());
}

}  // namespace
}  // namespace lxd::board_run_folder_test
