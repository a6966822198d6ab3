// SPDX-License-Identifier: Apache-2.0
// What a damaged, foreign or interrupted map archive does: a message that names file and cause, and what was committed
// stays.
#include <csignal>

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "backend/archive.hpp"
#include "backend/cloud.hpp"
#include "backend/mesh_export.hpp"
#include "tests/support/synthetic_mesh.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::archive_damage_test {
namespace {

using test::SyntheticMesh;
using test::TemporaryFolder;

class DamagedArchive : public ::testing::Test {
 protected:
  void SetUp() override {
    mesh_.add_room({0, 0, 0}, {5, 4, 3});
    auto writer = ArchiveWriter::create(file_);
    ASSERT_TRUE(writer.ok());
    for (int id = 0; id < 4; ++id) ASSERT_TRUE(writer->append(mesh_.view(id)).ok());
    ASSERT_TRUE(writer->finish().ok());
  }

  void execute(const char* sql) {
    sqlite3* handle = nullptr;
    ASSERT_EQ(sqlite3_open(file_.c_str(), &handle), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(handle, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(handle);
    sqlite3_close(handle);
  }

  void expect_open_error(const std::string& cause) {
    const auto archive = Archive::open(file_);
    ASSERT_FALSE(archive.ok());
    EXPECT_NE(archive.error().message.find(file_.string()), std::string::npos) << archive.error().message;
    EXPECT_NE(archive.error().message.find(cause), std::string::npos) << archive.error().message;
  }

  void expect_read_error(const std::string& cause) {
    const auto archive = Archive::open(file_);
    ASSERT_TRUE(archive.ok()) << archive.error().message;
    const Status read = archive->for_each_submesh([](const SubmeshView&) { return success(); });
    ASSERT_FALSE(read.ok());
    EXPECT_NE(read.error().message.find(cause), std::string::npos) << read.error().message;
    EXPECT_FALSE(write_mesh_ply(folder_ / "mesh.ply", *archive).ok());
    EXPECT_FALSE(std::filesystem::exists(folder_ / "mesh.ply"));
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "map.db";
  SyntheticMesh mesh_;
};

TEST_F(DamagedArchive, MissingIsNamed) {
  std::filesystem::remove(file_);
  expect_open_error("No such file");
}

TEST_F(DamagedArchive, AnotherKindOfFileIsNoArchive) {
  test::write_file(file_, std::string(5000, 'x'));
  expect_open_error("not a map archive");
  test::write_file(file_, "");
  expect_open_error("not a map archive");
}

TEST_F(DamagedArchive, AnotherProgramsDatabaseIsNoArchive) {
  execute("PRAGMA application_id = 77");
  expect_open_error("no map archive");
}

TEST_F(DamagedArchive, AnotherVersionSaysBoth) {
  execute("PRAGMA user_version = 999");
  expect_open_error("version 999, this program reads version 2");
}

// What the first version wrote has no key frames: nothing could be found in it.
TEST_F(DamagedArchive, TheVersionBeforeIsRefused) {
  execute("PRAGMA user_version = 1");
  expect_open_error("version 1, this program reads version 2");
}

TEST_F(DamagedArchive, KeyFrameThatIsNoPoseIsNotRead) {
  execute("INSERT INTO keyframe VALUES (1, 7, x'0000')");
  expect_read_error("sub-mesh 1: a key frame's pose");
}

TEST_F(DamagedArchive, TruncatedSaysFoundAndWanted) {
  const auto size = std::filesystem::file_size(file_);
  std::filesystem::resize_file(file_, size / 2);
  expect_open_error("truncated");
  expect_open_error(std::to_string(size));
}

TEST_F(DamagedArchive, HalfAVertexIsNotRead) {
  execute("UPDATE submesh SET vertices = substr(vertices, 1, 30) WHERE id = 2");
  expect_read_error("sub-mesh 2: vertices are not whole");
}

TEST_F(DamagedArchive, FaceBeyondTheVerticesIsNotRead) {
  execute("UPDATE submesh SET vertices = substr(vertices, 1, 28) WHERE id = 3");
  expect_read_error("sub-mesh 3: a face names a vertex that does not exist");
}

TEST_F(DamagedArchive, PoseThatIsNoPoseIsNotRead) {
  execute("UPDATE submesh SET T_map_submesh = x'0000' WHERE id = 1");
  expect_read_error("sub-mesh 1: pose");
}

TEST_F(DamagedArchive, OverwrittenPagesAreAnErrorNotACrash) {
  std::string bytes = test::read_file(file_);
  for (std::size_t i = 4096; i < bytes.size(); i += 5) bytes[i] = static_cast<char>(i * 31);
  test::write_file(file_, bytes);
  const auto archive = Archive::open(file_);
  const bool sound = archive.ok() && archive->for_each_submesh([](const SubmeshView&) { return success(); }).ok();
  EXPECT_FALSE(sound);
}

TEST_F(DamagedArchive, ReadOnlyArchiveIsRead) {
  std::filesystem::permissions(file_, std::filesystem::perms::owner_read);
  const auto archive = Archive::open(file_);
  ASSERT_TRUE(archive.ok()) << archive.error().message;
  EXPECT_EQ(archive->totals().submeshes, 4U);
}

TEST(ArchiveInMissingFolder, NamesTheFile) {
  const auto writer = ArchiveWriter::create("/nonexistent/map.db");
  ASSERT_FALSE(writer.ok());
  EXPECT_NE(writer.error().message.find("/nonexistent/map.db"), std::string::npos);
}

// Runs the story in a process of its own and gives its exit status; -1 when it was killed.
template <typename Story>
int in_child(Story story) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(story());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ArchiveOfAKilledRun, KeepsEverySubmeshThatWasAppended) {
  const TemporaryFolder folder;
  SyntheticMesh mesh;
  mesh.add_room({0, 0, 0}, {5, 4, 3});
  const int status = in_child([&] {
    auto writer = ArchiveWriter::create(folder / "map.db");
    for (int id = 0; id < 3; ++id)
      if (!writer->append(mesh.view(id)).ok()) return 1;
    return ::kill(::getpid(), SIGKILL);
  });
  ASSERT_EQ(status, -1) << "the writer was to be killed";
  const auto archive = Archive::open(folder / "map.db");
  ASSERT_TRUE(archive.ok()) << archive.error().message;
  EXPECT_EQ(archive->totals().submeshes, 3U);
}

TEST(ArchiveOfAKilledRun, HalfWrittenSubmeshLeavesTheRest) {
  const TemporaryFolder folder;
  SyntheticMesh mesh;
  mesh.add_room({0, 0, 0}, {5, 4, 3});
  {
    auto writer = ArchiveWriter::create(folder / "map.db");
    ASSERT_TRUE(writer->append(mesh.view(0)).ok());
    ASSERT_TRUE(writer->append(mesh.view(1)).ok());
    // The machine stops while the log holds half of the last transaction.
    std::filesystem::create_directory(folder / "disk");
    std::filesystem::copy_file(folder / "map.db", folder / "disk/map.db");
    std::filesystem::copy_file(folder / "map.db-wal", folder / "disk/map.db-wal");
  }
  const auto log = folder / "disk/map.db-wal";
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 10'000);
  const auto archive = Archive::open(folder / "disk/map.db");
  ASSERT_TRUE(archive.ok()) << archive.error().message;
  EXPECT_EQ(archive->totals().submeshes, 1U);
  EXPECT_TRUE(archive->for_each_submesh([](const SubmeshView&) { return success(); }).ok());
}

constexpr rlim_t kDiskBytes = 200'000;

// A file-size limit stands in for a full disk: the same path through write(), another errno.
void fill_disk() {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{kDiskBytes, kDiskBytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

TEST(FullDisk, ArchiveSaysSoAndKeepsWhatItHas) {
  const TemporaryFolder folder;
  SyntheticMesh mesh;
  mesh.add_room({0, 0, 0}, {5, 4, 3});
  const int appended = in_child([&] {
    auto writer = ArchiveWriter::create(folder / "map.db");
    fill_disk();
    for (int id = 0; id < 100; ++id)
      if (const Status done = writer->append(mesh.view(id)); !done.ok())
        return done.error().message.find("map.db") != std::string::npos ? id : 100;
    return 100;
  });
  ASSERT_GE(appended, 1);
  ASSERT_LT(appended, 100);
  const auto archive = Archive::open(folder / "map.db");
  ASSERT_TRUE(archive.ok()) << archive.error().message;
  EXPECT_EQ(archive->totals().submeshes, static_cast<std::uint64_t>(appended));
}

// As above, but there may be room again.
void set_disk(rlim_t bytes) {
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = bytes;
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

// Given an archive that had no room for some sub-meshes, when there is room again, then it goes on as if nothing was.
TEST(FullDisk, ArchiveGoesOnWhenThereIsRoom) {
  const TemporaryFolder folder;
  SyntheticMesh mesh;
  mesh.add_room({0, 0, 0}, {5, 4, 3});
  const int lost = in_child([&] {
    auto writer = ArchiveWriter::create(folder / "map.db");
    int refused = 0;
    for (int id = 0; id < 20; ++id) {
      set_disk(id >= 5 && id < 10 ? 20'000 : RLIM_INFINITY);
      refused += writer->append(mesh.view(id)).ok() ? 0 : 1;
    }
    return writer->finish().ok() ? refused : 100;
  });
  EXPECT_EQ(lost, 5);
  const auto archive = Archive::open(folder / "map.db");
  ASSERT_TRUE(archive.ok()) << archive.error().message;
  EXPECT_EQ(archive->totals().submeshes, 15U);
  EXPECT_TRUE(archive->for_each_submesh([](const SubmeshView&) { return success(); }).ok());
}

TEST(FullDisk, CloudSaysSoAndGoesOnWhenThereIsRoom) {
  const TemporaryFolder folder;
  const int told = in_child([&] {
    auto writer = CloudWriter::create(folder / "cloud.ply");
    const std::vector<CloudPoint> points(100'000);
    set_disk(kDiskBytes);
    const Status appended = writer->append(points);
    set_disk(RLIM_INFINITY);
    const bool said = !appended.ok() && appended.error().message.find("cloud.ply") != std::string::npos;
    return said && writer->append(points).ok() && writer->close().ok() ? 7 : 0;
  });
  EXPECT_EQ(told, 7);
  const auto cloud = CloudReader::open(folder / "cloud.ply");
  ASSERT_TRUE(cloud.ok()) << cloud.error().message;
  EXPECT_GE(cloud->size(), 100'000U);
  EXPECT_LT(cloud->size(), 200'000U);
}

}  // namespace
}  // namespace lxd::archive_damage_test
