// SPDX-License-Identifier: Apache-2.0
// A recorded serial line: written, read back, damaged.
#include <gtest/gtest.h>

#include "drivers/replay/imu_log.hpp"
#include "drivers/replay/serial_log.hpp"
#include "drivers/replay/serial_log_writer.hpp"
#include "tests/support/serial_stream.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/imu/imu_encoder.hpp"
#include "tools/simulator/imu/vectornav_encoder.hpp"
#include "tools/simulator/imu/witmotion_encoder.hpp"

namespace lxd::drivers_serial_log_test {
namespace {

using test::Bytes;
using test::read_file;
using test::TemporaryFolder;
using test::write_file;

struct Piece {
  std::int64_t ns;
  Bytes bytes;
  bool operator==(const Piece&) const = default;
};

void write_pieces(const std::filesystem::path& path, const std::vector<Piece>& pieces) {
  auto writer = SerialLogWriter::create(path);
  ASSERT_TRUE(writer.ok());
  for (const Piece& piece : pieces) ASSERT_TRUE(writer->append(RigTime::from_ns(piece.ns), piece.bytes).ok());
  ASSERT_TRUE(writer->close().ok());
}

std::vector<Piece> read_pieces(const std::filesystem::path& path, Rejections& rejected) {
  auto log = SerialLog::open(path);
  EXPECT_TRUE(log.ok());
  std::vector<Piece> pieces;
  SerialChunk chunk;
  while (log->next(chunk, rejected)) pieces.push_back({chunk.received.ns(), {chunk.bytes.begin(), chunk.bytes.end()}});
  return pieces;
}

const std::vector<Piece> kPieces{{1'700'000'000'000'000'001, {1, 2, 3}}, {1'700'000'000'000'000'002, {4}}};

TEST(SerialLog, IsReadAsItWasWritten) {
  const TemporaryFolder folder;
  write_pieces(folder / "imu.serial", kPieces);
  Rejections rejected;
  EXPECT_EQ(read_pieces(folder / "imu.serial", rejected), kPieces);
  EXPECT_TRUE(rejected.empty());
}

TEST(SerialLog, ItsBytesAreAsDocumented) {
  const TemporaryFolder folder;
  write_pieces(folder / "imu.serial", {{0x0102030405060708, {0xAA}}});
  EXPECT_EQ(read_file(folder / "imu.serial"), std::string("LXDSER1\n"
                                                          "\x08\x07\x06\x05\x04\x03\x02\x01"
                                                          "\x01\x00\x00\x00"
                                                          "\xAA",
                                                          21));
}

TEST(SerialLog, MoreThanAChunkHoldsBecomesSeveral) {
  const TemporaryFolder folder;
  const Bytes many(2 * kSerialChunkMax + 5, 7);
  write_pieces(folder / "imu.serial", {{1, many}});
  Rejections rejected;
  Bytes all;
  for (const Piece& piece : read_pieces(folder / "imu.serial", rejected)) test::append(all, piece.bytes);
  EXPECT_EQ(all, many);
}

TEST(SerialLog, ATruncatedFileGivesWhatItHasAndIsCounted) {
  const TemporaryFolder folder;
  write_pieces(folder / "imu.serial", kPieces);
  const std::string whole = read_file(folder / "imu.serial");
  constexpr std::size_t kFirstEnd = 8 + 12 + 3;
  for (std::size_t length = 8; length < whole.size(); ++length) {
    write_file(folder / "cut.serial", whole.substr(0, length));
    Rejections rejected;
    const auto pieces = read_pieces(folder / "cut.serial", rejected);
    std::size_t bytes = 0;
    for (const Piece& piece : pieces) bytes += piece.bytes.size();
    EXPECT_EQ(bytes, length < 20 ? 0 : std::min<std::size_t>(length - 20, 3)) << length;
    const bool between_chunks = length == 8 || length == kFirstEnd;
    EXPECT_EQ(rejected, between_chunks ? Rejections{} : (Rejections{{"truncated_file", 1}})) << length;
  }
}

TEST(SerialLog, AWrongBeginNamesTheFileAndTheOffset) {
  const TemporaryFolder folder;
  write_file(folder / "imu.serial", "LXDSER2\n");
  const auto other = SerialLog::open(folder / "imu.serial");
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().message.find("imu.serial: offset 6: found 0x32, wanted 0x31"), std::string::npos)
      << other.error().message;

  write_file(folder / "imu.serial", "LXD");
  const auto cut = SerialLog::open(folder / "imu.serial");
  ASSERT_FALSE(cut.ok());
  EXPECT_NE(cut.error().message.find("imu.serial: ends at offset 3"), std::string::npos) << cut.error().message;

  EXPECT_FALSE(SerialLog::open(folder / "missing.serial").ok());
  EXPECT_FALSE(SerialLog::open(folder.path()).ok());
}

TEST(SerialLog, AChunkBeyondReasonEndsTheFileAndIsCounted) {
  const TemporaryFolder folder;
  write_pieces(folder / "imu.serial", kPieces);
  std::string damaged = read_file(folder / "imu.serial");
  damaged[8 + 12 + 3 + 11] = '\x7F';  // high byte of the second chunk's length
  write_file(folder / "imu.serial", damaged);
  Rejections rejected;
  EXPECT_EQ(read_pieces(folder / "imu.serial", rejected).size(), 1U);
  EXPECT_EQ(rejected, (Rejections{{"oversized_chunk", 1}}));
}

TEST(SerialLog, TimesThatGoBackAreCounted) {
  const TemporaryFolder folder;
  write_pieces(folder / "imu.serial", {{5, {1}}, {4, {2}}, {6, {3}}});
  Rejections rejected;
  EXPECT_EQ(read_pieces(folder / "imu.serial", rejected).size(), 3U);
  EXPECT_EQ(rejected, (Rejections{{"time_backwards", 1}}));
}

// Found by fuzzing: arithmetic with such a time overflows.
TEST(SerialLog, AChunkWithATimeBeyondReasonIsPassedOver) {
  const TemporaryFolder folder;
  write_pieces(folder / "imu.serial", {{5, {1}}, {INT64_MIN, {2}}, {INT64_MAX, {3}}, {6, {4}}});
  Rejections rejected;
  EXPECT_EQ(read_pieces(folder / "imu.serial", rejected), (std::vector<Piece>{{5, {1}}, {6, {4}}}));
  EXPECT_EQ(rejected, (Rejections{{"bad_time", 2}}));
}

TEST(SerialLogWriter, AFullDiskIsToldWithTheFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  auto writer = SerialLogWriter::create("/dev/full");
  ASSERT_TRUE(writer.ok());
  Status status = writer->append(RigTime::from_ns(1), Bytes(100'000, 1));
  if (status.ok()) status = writer->close();
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("/dev/full: cannot be written: No space"), std::string::npos)
      << status.error().message;
}

TEST(SerialLogWriter, AFileThatCannotBeMadeIsTold) {
  const TemporaryFolder folder;
  EXPECT_FALSE(SerialLogWriter::create(folder / "none" / "imu.serial").ok());
}

// Given any protocol in pieces that do not know of frames, then all samples come, with the damage counted.
TEST(ImuLog, GivesTheSamplesOfAnyProtocol) {
  const TemporaryFolder folder;
  const sim::Inertial sample{{0.1, 0.2, 0.3}, {0, 0, 9.8}};
  constexpr std::int64_t kMilli = 1'000'000;
  for (const std::string_view name : kImuProtocolNames) {
    const ImuProtocol protocol = *find_imu_protocol(name);
    const std::int64_t start_ns = protocol == ImuProtocol::kXsens ? 0 : 1'700'000'000'000'000'000;
    std::vector<Piece> pieces{{1, {0xFA, 0x55, 0x00}}};  // begun in the middle of a frame
    for (std::int64_t i = 0; i < 50; ++i) {
      const std::int64_t ns = start_ns + i * kMilli;
      const Bytes frame = sim::encode_sample(protocol, 0, ns, sample);
      pieces.push_back({ns, {frame.begin(), frame.begin() + 5}});
      pieces.push_back({ns + 1, {frame.begin() + 5, frame.end()}});
    }
    write_pieces(folder / "imu.serial", pieces);
    auto log = ImuLog::open(folder / "imu.serial", protocol, 115200);
    ASSERT_TRUE(log.ok());
    ImuSample read;
    std::int64_t count = 0;
    for (; log->next(read); ++count) {
      EXPECT_EQ(read.sensor_ns.value_or(start_ns + count * kMilli), start_ns + count * kMilli);
      EXPECT_EQ(read.sensor_ns.has_value(), protocol != ImuProtocol::kVectorNavAscii);
    }
    EXPECT_EQ(count, 50) << name_of(protocol);
    EXPECT_EQ(log->samples(), 50U);
    EXPECT_EQ(log->rejected().at("skipped_byte"), 3U);
  }
}

TEST(ImuLog, AFileThatIsNoneIsAnError) {
  const TemporaryFolder folder;
  EXPECT_FALSE(ImuLog::open(folder / "imu.serial", ImuProtocol::kVectorNav, 115200).ok());
}

TEST(ImuProtocol, IsFoundByItsName) {
  EXPECT_EQ(find_imu_protocol("witmotion"), ImuProtocol::kWitMotion);
  EXPECT_EQ(find_imu_protocol("xsens"), ImuProtocol::kXsens);
  EXPECT_EQ(find_imu_protocol("nmea"), std::nullopt);
}

}  // namespace
}  // namespace lxd::drivers_serial_log_test
