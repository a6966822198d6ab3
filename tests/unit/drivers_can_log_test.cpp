// SPDX-License-Identifier: Apache-2.0
// Logs of candump -L: every form of a line, what is garbage, and lines that come back as they were written.
#include <gtest/gtest.h>

#include "drivers/replay/can_log.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::drivers_can_log_test {
namespace {

CanLogLine parse(std::string_view line) {
  CanLogRecord record;
  return parse_can_log_line(line, record);
}

CanFrame frame_of(std::string_view line) {
  CanLogRecord record;
  EXPECT_EQ(parse_can_log_line(line, record), CanLogLine::frame) << line;
  return record.frame;
}

TEST(CanLogLines, DataFrame) {
  CanLogRecord record;
  ASSERT_EQ(parse_can_log_line("(1436509052.249713) vcan0 044#2A366C2BBA\n", record), CanLogLine::frame);
  EXPECT_EQ(record.frame.received.ns(), 1'436'509'052'249'713'000);
  EXPECT_EQ(record.interface_name(), "vcan0");
  EXPECT_EQ(record.frame.id, 0x044U);
  EXPECT_FALSE(record.frame.extended);
  EXPECT_EQ(record.frame.kind, CanKind::data);
  EXPECT_EQ(record.frame.length, 5);
  EXPECT_EQ(record.frame.data, (CanData{0x2A, 0x36, 0x6C, 0x2B, 0xBA, 0, 0, 0}));
}

TEST(CanLogLines, OtherForms) {
  EXPECT_EQ(frame_of("(1.000000) can0 123#").length, 0);
  const CanFrame extended = frame_of("(1.000000) can0 18FF1234#01\r\n");
  EXPECT_TRUE(extended.extended);
  EXPECT_EQ(extended.id, 0x18FF1234U);
  EXPECT_TRUE(frame_of("(1.000000) can0 00000123#01").extended);
  EXPECT_EQ(frame_of("(1.000000) can0 123#R").kind, CanKind::remote);
  EXPECT_EQ(frame_of("(1.000000) can0 123#R4").length, 4);
  EXPECT_EQ(frame_of("(1.000000) can0 123#0102 R").length, 2);  // the direction that candump -x adds
  const CanFrame error = frame_of("(1.000000) can0 20000040#0000000000000000");
  EXPECT_EQ(error.kind, CanKind::error);
  EXPECT_EQ(error.id, kCanErrorBusOff);
  EXPECT_FALSE(error.extended);
  EXPECT_EQ(parse("(1.000000) can0 123##1AABB"), CanLogLine::can_fd);
  EXPECT_EQ(parse("\r\n"), CanLogLine::blank);
}

TEST(CanLogLines, Garbage) {
  for (const char* const line : {"hello",
                                 "(1.0",
                                 "(1.000000)",
                                 "(1.000000) can0",
                                 "(1.000000) can0 123",
                                 "(1.000000)can0 123#01",
                                 "(1e3) can0 123#01",
                                 "(-1.0) can0 123#01",
                                 "(1.0.0) can0 123#01",
                                 "() can0 123#01",
                                 "(1.0) can0 12#01",
                                 "(1.0) can0 1234#01",
                                 "(1.0) can0 XYZ#01",
                                 "(1.0) can0 800#01",
                                 "(1.0) can0 80000000#01",
                                 "(1.0) can0 123#0",
                                 "(1.0) can0 123#0G",
                                 "(1.0) can0 123#R9",
                                 "(1.0) can0 123#R10",
                                 "(1.0) can0 123#001122334455667788",
                                 "(1.0) a_name_of_16_char 123#01",
                                 "(1.0)  123#01",
                                 "(99999999999999999999.0) can0 123#01",
                                 "(1.0) can0 20000040#R"})
    EXPECT_EQ(parse(line), CanLogLine::garbage) << line;
}

TEST(CanLogLines, EveryTruncationIsGarbageOrShorter) {
  const std::string line = "(1436509052.249713) can0 0B4#00000000120FA07D";
  const std::size_t data = line.find('#') + 1;
  for (std::size_t size = 1; size < line.size(); ++size) {
    const CanLogLine kind = parse(line.substr(0, size));
    const bool whole_bytes = size >= data && (size - data) % 2 == 0;
    EXPECT_EQ(kind, whole_bytes ? CanLogLine::frame : CanLogLine::garbage) << size;
  }
}

TEST(CanLogLines, WrittenAsCandumpDoes) {
  for (const std::string line :
       {"(1436509052.249713) vcan0 044#2A366C2BBA\n", "(0000000007.000001) can1 18FF1234#01\n",
        "(1700000000.999999) can0 20000040#0000000000000000\n", "(1700000000.000000) can0 123#R\n",
        "(1700000000.000000) can0 123#R8\n", "(1700000000.000000) can0 7FF#\n"}) {
    CanLogRecord record;
    ASSERT_EQ(parse_can_log_line(line, record), CanLogLine::frame);
    EXPECT_EQ(can_log_line(record), line);
  }
}

TEST(CanLogLines, AnyFrameComesBack) {
  sim::Random random(11, "frames");
  for (int i = 0; i < 2000; ++i) {
    CanLogRecord record;
    record.set_interface("can0");
    CanFrame& frame = record.frame;
    frame.kind = static_cast<CanKind>(random.bits() % 3);
    frame.extended = frame.kind != CanKind::error && random.chance(0.5);
    const bool long_id = frame.extended || frame.kind == CanKind::error;
    frame.id = static_cast<std::uint32_t>(random.bits()) & (long_id ? kCanExtendedIdMax : kCanStandardIdMax);
    if (frame.kind == CanKind::error) frame.id &= ~0x20000000U;
    frame.length = static_cast<std::uint8_t>(random.bits() % 9);
    for (std::size_t k = 0; frame.kind != CanKind::remote && k < frame.length; ++k)
      frame.data[k] = static_cast<std::uint8_t>(random.bits());
    frame.received = RigTime::from_ns(static_cast<std::int64_t>(random.bits() % 4'000'000'000'000'000) * 1000);
    CanLogRecord back;
    ASSERT_EQ(parse_can_log_line(can_log_line(record), back), CanLogLine::frame) << can_log_line(record);
    EXPECT_EQ(back.frame, frame) << can_log_line(record);
  }
}

TEST(CanLogFiles, GarbageIsCountedWithItsLines) {
  const test::TemporaryFolder folder;
  test::write_file(
      folder / "can.log",
      "(2.000000) can0 123#01\r\nnoise\r\n\r\n(1.000000) can0 124#02\r\n(3.0) can0 1##1AA\n(4.0) can0 125#03");
  auto reader = CanLogReader::open(folder / "can.log");
  ASSERT_TRUE(reader.ok());
  std::vector<std::uint32_t> ids;
  for (CanLogRecord record; reader->next(record);) ids.push_back(record.frame.id);
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{0x123, 0x124, 0x125}));
  EXPECT_EQ(reader->frames(), 3U);
  EXPECT_EQ(reader->garbage_lines(), (std::vector<std::uint64_t>{2, 5}));
  EXPECT_EQ(reader->time_backwards(), 1U);
}

TEST(CanLogFiles, MissingFileIsAnError) {
  const test::TemporaryFolder folder;
  const auto reader = CanLogReader::open(folder / "no.log");
  ASSERT_FALSE(reader.ok());
  EXPECT_NE(reader.error().message.find("no.log"), std::string::npos);
  EXPECT_FALSE(CanLogReader::open(folder.path()).ok());
}

}  // namespace
}  // namespace lxd::drivers_can_log_test
