// SPDX-License-Identifier: Apache-2.0
// Every capture at hand through parser, assembler and sweep builder: as many packets, columns and points as there are.
// Packets were counted by tests/support/replay_golden.py's reader, which shares no code with the product.
#include <gtest/gtest.h>

#include "drivers/ouster/sweep_builder.hpp"
#include "tests/support/replay_ouster.hpp"

namespace lxd::drivers_ouster_captures_test {
namespace {

using replay_test::clone_ouster;
using replay_test::shared_ouster;

struct Capture {
  const char *pcap, *json;
  const char* profile;
  std::uint64_t packets, frames;
};

constexpr Capture kCloned[] = {
    {"OS-0-32-U1_v2.2.0_1024x10.pcap", "OS-0-32-U1_v2.2.0_1024x10.json", "RNG19_RFL8_SIG16_NIR16_DUAL", 64, 1},
    {"OS-1-128_767798045_1024x10_20230712_120049.pcap", "OS-1-128_767798045_1024x10_20230712_120049.json",
     "FUSA_RNG15_RFL8_NIR8_DUAL", 8, 1},
    {"OS-1-32-G_v2.1.1_1024x10.pcap", "OS-1-32-G_v2.1.1_1024x10.json", "LEGACY", 64, 1},
    {"windowed_frame1.pcap", "windowed_frame1_0.json", "RNG15_RFL8_NIR8", 17, 1},
    {"duplicate_id.pcap", "duplicate_id.json", "RNG15_RFL8_NIR8", 1, 1}};
constexpr Capture kShared[] = {
    {"OS-1-128_v2.3.0_1024x10_lb_n3.pcap", "OS-1-128_v2.3.0_1024x10.json", "RNG15_RFL8_NIR8", 192, 3},
    {"OS-1-64_1024x10_fw20.pcap", "metadata/2_0_0_os1-991913000010-64.json", "LEGACY", 64, 1},
    {"same_ports_legacy.pcap", "same_ports_legacy.1.json", "LEGACY", 1, 1},
    {"same_ports_legacy.pcap", "same_ports_legacy.2.json", "LEGACY", 1, 1}};

// Parses all datagrams of the format's size; the others are another sensor's, or the IMU's.
void expect_decoded(const std::filesystem::path& pcap, const std::filesystem::path& json, const Capture& capture) {
  const OusterMetadata metadata = replay_test::must_read_metadata(json);
  ASSERT_NE(metadata.format.profile, nullptr) << capture.pcap;
  EXPECT_EQ(metadata.format.profile->name, capture.profile) << capture.pcap;
  OusterPacketParser parser(metadata.format, metadata.columns_per_frame, metadata.init_id, metadata.serial);
  OusterFrameAssembler assembler(metadata.format, metadata.columns_per_frame);
  OusterSweepBuilder builder(metadata);
  std::vector<LidarPoint> storage(2 * std::size_t{metadata.columns_per_frame} * metadata.format.pixels_per_column);
  Sweep sweep;
  sweep.storage = storage;
  OusterPacket packet;
  std::uint64_t sweeps = 0;
  const auto build = [&](const OusterFrame* frame) { sweeps += frame != nullptr && builder.build(*frame, sweep); };
  for (const auto& bytes : replay_test::datagrams(pcap, metadata.format.packet_bytes())) {
    if (parser.parse(bytes, packet)) build(assembler.add(packet));
  }
  build(assembler.flush());
  EXPECT_EQ(parser.counts().packets, capture.packets) << capture.pcap;
  EXPECT_EQ(parser.counts().bad_crc + parser.counts().bad_init_id + parser.counts().bad_serial, 0U) << capture.pcap;
  EXPECT_EQ(sweeps, capture.frames) << capture.pcap;
  EXPECT_EQ(builder.counts().above_capacity + builder.counts().bad_column_time, 0U) << capture.pcap;
  EXPECT_GT(sweep.count, 0U) << capture.pcap;
}

TEST(OusterCaptures, OfTheCloneAreDecoded) {
  for (const Capture& capture : kCloned) {
    expect_decoded(clone_ouster() / capture.pcap, clone_ouster() / capture.json, capture);
  }
}

TEST(OusterCaptures, OfTheSharedFolderAreDecoded) {
  for (const Capture& capture : kShared) {
    const auto pcap = shared_ouster(capture.pcap), json = shared_ouster(capture.json);
    if (!pcap || !json) GTEST_SKIP() << "no LXD_SHARED_DATA with ouster/" << capture.pcap;
    expect_decoded(*pcap, *json, capture);
  }
}

}  // namespace
}  // namespace lxd::drivers_ouster_captures_test
