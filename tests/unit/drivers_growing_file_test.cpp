// SPDX-License-Identifier: Apache-2.0
// Files of records that grow: whole records only, whatever ends them; and the sentences of a receiver's line.
#include <csignal>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "drivers/replay/growing_file.hpp"
#include "drivers/replay/nmea_log.hpp"
#include "drivers/replay/nmea_log_writer.hpp"
#include "tests/support/loopback.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::test::drivers_growing_file_test {
namespace {

// No file of this process grows beyond, while it lives: stands in for a full disk.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    old_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, old_);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit before_{};
  void (*old_)(int) = nullptr;
};

TEST(GrowingFile, HasWhatWasFlushedBeforeItIsClosed) {
  const TemporaryFolder folder;
  auto file = GrowingFile::create(folder / "log");
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE(file->append({bytes_of("one "), bytes_of("record")}).ok());
  EXPECT_EQ(read_file(folder / "log"), "");
  ASSERT_TRUE(file->flush().ok());
  EXPECT_EQ(read_file(folder / "log"), "one record");
  EXPECT_EQ(file->flushed_bytes(), 10U);
}

// Given a disk that is full in the midst of a record, then the file ends behind the last whole one that was flushed,
// says so, and takes nothing more even when there is room again.
TEST(GrowingFile, EndsBehindAWholeRecordWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  auto file = GrowingFile::create(folder / "log");
  ASSERT_TRUE(file.ok());
  {
    const FileLimit limit(25);
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(file->append({bytes_of("ten bytes.")}).ok());
      ASSERT_TRUE(file->flush().ok());
    }
    ASSERT_TRUE(file->append({bytes_of("ten bytes.")}).ok());
    const Status full = file->flush();
    ASSERT_FALSE(full.ok());
    EXPECT_NE(full.error().message.find("log: cannot be written"), std::string::npos) << full.error().message;
  }
  EXPECT_FALSE(file->append({bytes_of("more")}).ok());
  EXPECT_FALSE(file->close().ok());
  EXPECT_EQ(read_file(folder / "log"), "ten bytes.ten bytes.");
}

// Given a receiver's line in pieces that do not know of sentences, then each line of the log is a sentence with the
// time of its `$`.
TEST(NmeaLogWriter, CutsALineIntoSentences) {
  const TemporaryFolder folder;
  auto log = NmeaLogWriter::create(folder / "gnss.nmea");
  ASSERT_TRUE(log.ok());
  const auto at = [](std::int64_t s) { return RigTime::from_ns(s * kNanosPerSecond + 5); };
  ASSERT_TRUE(log->append(at(1), bytes_of("tail*00\r\n$GPGGA,1")).ok());
  ASSERT_TRUE(log->append(at(2), bytes_of("2*34\r")).ok());
  ASSERT_TRUE(log->append(at(3), bytes_of("\n$GPR$GPRMC*11\r\n")).ok());
  ASSERT_TRUE(log->append(at(4), bytes_of(std::string(300, 'x'))).ok());
  ASSERT_TRUE(log->close().ok());
  EXPECT_EQ(read_file(folder / "gnss.nmea"),
            "1.000000005 tail*00\n1.000000005 $GPGGA,12*34\n3.000000005 $GPR\n"
            "3.000000005 $GPRMC*11\n4.000000005 " +
                std::string(256, 'x') + "\n4.000000005 " + std::string(44, 'x') + "\n");
}

}  // namespace
}  // namespace lxd::test::drivers_growing_file_test
