// SPDX-License-Identifier: Apache-2.0
// Captures that the recorder and the simulator write: fragments, check sums, receive stamps, and failures that are
// told.
#include <gtest/gtest.h>

#include "drivers/replay/pcap_writer.hpp"
#include "tests/support/captured_datagrams.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::test::drivers_pcap_writer_test {
namespace {

using namespace sim;
using Bytes = std::vector<std::uint8_t>;

const UdpRoute kRoute{{{192, 168, 1, 120}, 7502}, {{192, 168, 1, 5}, 7502}};
constexpr RigTime kStart = RigTime::from_ns(1'767'268'800'123'456'789);

Bytes noise(std::size_t bytes, std::uint64_t number) {
  Random random(1, "payload", number);
  Bytes payload(bytes);
  for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random.bits());
  return payload;
}

PcapWriter must_create(const std::filesystem::path& path) {
  auto writer = PcapWriter::create(path, PcapStamps::of_wire);
  EXPECT_TRUE(writer.ok());
  return std::move(*writer);
}

std::uint32_t word_sum(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) sum += static_cast<std::uint32_t>(bytes[i]) << (i % 2 == 0 ? 8 : 0);
  return sum;
}
std::uint32_t folded(std::uint32_t sum) { return sum > 0xFFFF ? folded((sum & 0xFFFFU) + (sum >> 16U)) : sum; }

TEST(PcapWriter, DatagramsOfEverySizeComeBackWhole) {
  const TemporaryFolder folder;
  const std::vector<std::size_t> sizes{0, 1, 48, 1471, 1472, 1473, 2952, 2953, 12544, 33024, 65507};
  PcapWriter writer = must_create(folder / "a.pcap");
  for (const std::size_t size : sizes) ASSERT_TRUE(writer.write(kRoute, noise(size, size), kStart).ok());
  ASSERT_TRUE(writer.close().ok());
  const Capture capture = read_capture(folder / "a.pcap");
  ASSERT_EQ(capture.datagrams.size(), sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) EXPECT_EQ(capture.datagrams[i].bytes, noise(sizes[i], sizes[i]));
  EXPECT_EQ(capture.datagrams[2].source_address, 0xC0A80178U);
  EXPECT_EQ(capture.datagrams[2].port, 7502U);
  EXPECT_EQ(capture.ip.malformed + capture.ip.incomplete, 0U);
  EXPECT_EQ(capture.frames.size(), 5U + 2 + 2 + 3 + 9 + 23 + 45);  // 1472 bytes fit the first frame, 1480 each other
}

TEST(PcapWriter, HeadersAndDatagramsAddUpToTheirCheckSums) {
  UdpFramer framer;
  for (const std::size_t size : {0U, 7U, 100U, 5001U}) {
    const auto frames = framer.frames(kRoute, noise(size, size));
    std::uint32_t udp_sum = 17 + static_cast<std::uint32_t>(size) + 8 + word_sum(kRoute.source.address) +
                            word_sum(kRoute.destination.address);  // RFC 768's pseudo header
    for (const Bytes& frame : frames) {
      EXPECT_LE(frame.size(), 14U + 1500);
      EXPECT_EQ(folded(word_sum(std::span(frame).subspan(14, 20))), 0xFFFFU);
      udp_sum = folded(udp_sum + word_sum(std::span(frame).subspan(34)));
    }
    EXPECT_EQ(udp_sum, 0xFFFFU) << size;
  }
}

TEST(PcapWriter, ReceiveStampsKeepNanosecondsAndNeverRunBackwards) {
  const TemporaryFolder folder;
  PcapWriter writer = must_create(folder / "a.pcap");
  for (const std::int64_t at_ns : {0, 500'000, 400'000, 2'000'000}) {
    ASSERT_TRUE(writer.write(kRoute, noise(4000, 1), kStart + Duration::from_ns(at_ns)).ok());
  }
  ASSERT_TRUE(writer.close().ok());
  const Capture capture = read_capture(folder / "a.pcap");
  EXPECT_EQ(capture.frames.front(), kStart);
  EXPECT_EQ(capture.frames[9], kStart + Duration::from_ns(2'000'000));
  for (std::size_t i = 1; i < capture.frames.size(); ++i) EXPECT_LT(capture.frames[i - 1], capture.frames[i]);
}

TEST(PcapWriter, ALostFrameCostsItsDatagramOnly) {
  const TemporaryFolder folder;
  PcapWriter writer = must_create(folder / "a.pcap");
  for (std::uint64_t i = 0; i < 12; ++i) {
    const auto lost = i % 4 == 1 ? std::optional(i) : std::nullopt;
    ASSERT_TRUE(writer.write(kRoute, noise(4000, i), kStart, lost).ok());
  }
  ASSERT_TRUE(writer.close().ok());
  const Capture capture = read_capture(folder / "a.pcap");
  EXPECT_EQ(capture.datagrams.size(), 9U);
  EXPECT_EQ(capture.ip.incomplete, 3U);
}

TEST(PcapWriter, AFullDiskIsTold) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "/dev/full: not on this system";
  PcapWriter writer = must_create("/dev/full");
  Status status = success();
  for (int i = 0; i < 100 && status.ok(); ++i) status = writer.write(kRoute, noise(4000, 1), kStart);
  if (status.ok()) status = writer.close();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "/dev/full: cannot be written: No space left on device");
}

TEST(PcapWriter, AFolderThatIsNotThereIsTold) {
  const auto writer = PcapWriter::create("/no/such/folder/a.pcap", PcapStamps::of_wire);
  ASSERT_FALSE(writer.ok());
  EXPECT_EQ(writer.error().message, "/no/such/folder/a.pcap: cannot be written: No such file or directory");
}

}  // namespace
}  // namespace lxd::test::drivers_pcap_writer_test
