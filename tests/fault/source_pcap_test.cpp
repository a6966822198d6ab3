// SPDX-License-Identifier: Apache-2.0
// Ouster captures as a source: golden sweeps of real sensors, and captures that are cut, flipped or mixed.
#include <cstdio>
#include <cstring>

#include "drivers/replay/ouster_pcap.hpp"
#include "tests/support/replay_ouster.hpp"

namespace lxd::source_pcap_test {
namespace {

using namespace replay_test;

struct GoldenPoint {
  std::size_t index;
  double x_m, y_m, z_m;
};
// By tests/support/replay_golden.py, which shares no code with the product.
struct GoldenSweep {
  std::size_t points;
  std::int64_t duration_ns;
  double sum_x_m, sum_y_m, sum_z_m;
  GoldenPoint middle;
};

void expect_golden(const OwnedSweep& sweep, const GoldenSweep& golden) {
  ASSERT_EQ(sweep.points.size(), golden.points);
  EXPECT_EQ((sweep.header.end - sweep.header.begin).ns(), golden.duration_ns);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const LidarPoint& p : sweep.points) sum += Eigen::Vector3d(p.x_m, p.y_m, p.z_m);
  const double tolerance = 1e-6 * static_cast<double>(golden.points);  // m: rounding to float, point by point
  EXPECT_NEAR(sum.x(), golden.sum_x_m, tolerance);
  EXPECT_NEAR(sum.y(), golden.sum_y_m, tolerance);
  EXPECT_NEAR(sum.z(), golden.sum_z_m, tolerance);
  const LidarPoint& p = sweep.points[golden.middle.index];
  EXPECT_NEAR(p.x_m, golden.middle.x_m, 1e-5);
  EXPECT_NEAR(p.y_m, golden.middle.y_m, 1e-5);
  EXPECT_NEAR(p.z_m, golden.middle.z_m, 1e-5);
}

std::vector<OwnedSweep> read_capture(const std::filesystem::path& pcap, Counts& rejected) {
  const auto source = must_open(pcap);
  if (source == nullptr) return {};
  EXPECT_EQ(source->kind(), "ouster-pcap");
  auto sweeps = read_all(*source);
  rejected = source->rejected();
  return sweeps;
}

void expect_one_sweep(const char* name, const GoldenSweep& golden, const Counts& rejected) {
  Counts found;
  const auto sweeps = read_capture(clone_ouster() / name, found);
  ASSERT_EQ(sweeps.size(), 1U);
  expect_golden(sweeps[0], golden);
  EXPECT_EQ(sweeps[0].header.begin.ns(), 0);
  EXPECT_EQ(found, rejected);
}

TEST(ReplayPcapGolden, Legacy) {
  expect_one_sweep("OS-1-32-G_v2.1.1_1024x10.pcap",
                   {27310, 99910300, 27528.300728, 24873.942747, -1977.380976, {13655, 6.261407, -1.246694, -1.708448}},
                   {{"no_return", 32768 - 27310}});
}

TEST(ReplayPcapGolden, DualReturn) {
  expect_one_sweep("OS-0-32-U1_v2.2.0_1024x10.pcap",
                   {21803, 99793740, -2867.360527, -26444.5544, 2180.747647, {10901, 1.807581, -0.281274, -1.293624}},
                   {{"no_return", 32768 - 21631}});
}

TEST(ReplayPcapGolden, LowBandwidthWindowed) {
  expect_one_sweep("windowed_frame1.pcap",
                   {9246, 49816952, 11757.671796, 18455.994851, 14110.653463, {4623, 0.081796, 0.269047, 0.181637}},
                   {{"no_return", 256 * 128 - 9246}, {"invalid_column", 16}});
}

TEST(ReplayPcapGolden, SafetyProfile) {
  expect_one_sweep("OS-1-128_767798045_1024x10_20230712_120049.pcap",
                   {17462, 12413232, -13236.420652, 3465.361385, 1025.674483, {8731, -0.534056, 0.22183, 0.118419}},
                   {{"no_return", 11}});
}

TEST(ReplayPcapGolden, ThreeSweepsOf128BeamsFollowEachOther) {
  const auto pcap = shared_ouster("OS-1-128_v2.3.0_1024x10_lb_n3.pcap");
  if (!pcap) GTEST_SKIP() << "LXD_SHARED_DATA has no ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap";
  Counts rejected;
  const auto sweeps = read_capture(*pcap, rejected);
  ASSERT_EQ(sweeps.size(), 3U);
  expect_golden(sweeps[0],
                {107647, 99851390, 15229.476953, 205214.687204, 64598.953765, {53823, 5.204727, -0.450076, -1.887347}});
  expect_golden(sweeps[1],
                {107357, 99911550, 12101.628074, 199698.316035, 63377.942815, {53678, 79.187339, -7.808382, 4.038451}});
  expect_golden(sweeps[2],
                {107532, 99979000, 21344.241491, 196677.703669, 64243.454446, {53766, 7.093327, -0.349482, -1.923662}});
  EXPECT_EQ(sweeps[1].header.begin.ns(), 991687315250 - 991587364520);
  EXPECT_EQ(sweeps[2].header.sequence, 2U);
  EXPECT_EQ(rejected, (Counts{{"no_return", 3 * 131072 - 107647 - 107357 - 107532}}));
}

TEST(ReplayPcapGolden, OldFirmwareOfALegacySensor) {
  const auto pcap = shared_ouster("OS-1-64_1024x10_fw20.pcap");
  const auto json = shared_ouster("metadata/2_0_0_os1-991913000010-64.json");
  if (!pcap || !json) GTEST_SKIP() << "LXD_SHARED_DATA has no ouster/OS-1-64_1024x10_fw20.pcap with metadata";
  const test::TemporaryFolder folder;
  std::filesystem::copy(*pcap, folder.path() / "a.pcap");
  std::filesystem::copy(*json, folder.path() / "a.json");
  Counts rejected;
  const auto sweeps = read_capture(folder.path() / "a.pcap", rejected);
  ASSERT_FALSE(sweeps.empty());
  EXPECT_GT(sweeps[0].points.size(), 10000U);
  EXPECT_FALSE(rejected.contains("bad_size"));
}

// Two sensors send to one port; the other one's packets have another size.
TEST(ReplayPcap, PacketsOfAnotherSensorAreRefused) {
  const auto pcap = shared_ouster("same_ports_legacy.pcap");
  const auto json = shared_ouster("same_ports_legacy.2.json");
  if (!pcap || !json) GTEST_SKIP() << "LXD_SHARED_DATA has no ouster/same_ports_legacy.pcap";
  const test::TemporaryFolder folder;
  std::filesystem::copy(*pcap, folder.path() / "a.pcap");
  std::filesystem::copy(*json, folder.path() / "a.json");
  Counts rejected;
  EXPECT_LE(read_capture(folder.path() / "a.pcap", rejected).size(), 1U);
  EXPECT_EQ(rejected["bad_size"], 1U);
}

class ReplayDamagedPcap : public testing::Test {
 protected:
  // Two frames of 64 columns of 4 pixels, each datagram in two fragments.
  ReplayDamagedPcap() {
    std::vector<Packet> packets;
    for (const std::uint32_t frame : {1U, 2U}) {
      for (std::uint16_t column = 0; column < 64; column += 16) {
        packets.push_back(made_packet(metadata_, frame, column, 100'000'000ULL * frame + 1'000'000U * column, 5000));
      }
    }
    whole_ = made_pcap(packets, 600);
  }

  Counts read(std::vector<std::uint8_t> bytes) {
    points_ = sweeps_ = 0;
    auto pcap = PcapFile::from_stream(fmemopen(bytes.data(), bytes.size(), "rb"), "made.pcap");
    if (!pcap) return {{"not_opened", 1}};
    const auto source = make_ouster_source(std::move(*pcap), metadata_);
    for (const OwnedSweep& sweep : read_all(*source, 1000)) {
      points_ += sweep.points.size();
      ++sweeps_;
    }
    return source->rejected();
  }

  static constexpr std::size_t kPointsOfAPacket = 16 * 4;
  OusterMetadata metadata_ = made_metadata("LEGACY");
  std::vector<std::uint8_t> whole_;
  std::size_t points_ = 0, sweeps_ = 0;
};

TEST_F(ReplayDamagedPcap, WholeItGivesBothFrames) {
  EXPECT_TRUE(read(whole_).empty());
  EXPECT_EQ(sweeps_, 2U);
  EXPECT_EQ(points_, 8 * kPointsOfAPacket);
}

TEST_F(ReplayDamagedPcap, CutAtAnyPlaceLosesOnlyWhatIsCut) {
  const std::size_t packet_bytes = (whole_.size() - 24) / 8;
  for (std::size_t bytes = 1; bytes < whole_.size(); bytes += 7) {
    const Counts rejected = read({whole_.begin(), whole_.begin() + static_cast<std::ptrdiff_t>(bytes)});
    EXPECT_EQ(rejected.contains("not_opened"), bytes < 24) << bytes;
    const std::size_t whole_packets = bytes < 24 ? 0 : (bytes - 24) / packet_bytes;
    EXPECT_EQ(points_, whole_packets * kPointsOfAPacket) << bytes;
  }
}

TEST_F(ReplayDamagedPcap, FlippedBitsNeverBreakTheReader) {
  for (std::size_t bit = 0; bit < whole_.size() * 8; bit += bit < 4000 ? 1 : 11) {
    auto flipped = whole_;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    read(flipped);
    EXPECT_LE(points_, 8 * kPointsOfAPacket);
  }
}

TEST_F(ReplayDamagedPcap, LostFragmentLosesTheDatagramAndIsCounted) {
  std::uint32_t captured = 0;  // of the first record; its header follows the file's 24 bytes
  std::memcpy(&captured, &whole_[32], sizeof captured);
  auto without_first = whole_;
  without_first.erase(without_first.begin() + 24, without_first.begin() + 24 + 16 + captured);
  EXPECT_EQ(read(without_first), (Counts{{"incomplete_datagram", 1}}));
  EXPECT_EQ(points_, 7 * kPointsOfAPacket);
}

TEST(ReplayPcapMetadata, MissingMetadataListsWhatThereIs) {
  const test::TemporaryFolder folder;
  std::filesystem::copy(clone_ouster() / "duplicate_id.pcap", folder.path() / "drive.pcap");
  EXPECT_NE(open_error(folder.path() / "drive.pcap").find("found 0 .json files"), std::string::npos);
  write_text(folder.path() / "left.json", "{}");
  write_text(folder.path() / "right.json", "{}");
  const std::string message = open_error(folder.path() / "drive.pcap");
  for (const char* part :
       {"found 2 .json files", "wanted the sensor's metadata as drive.json", "left.json", "right.json"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

TEST(ReplayPcapMetadata, NearestNameWins) {
  const test::TemporaryFolder folder;
  const auto pcap = folder.path() / "drive_a_n3.pcap";
  const auto found = [&] { return find_ouster_metadata(pcap).value().filename().string(); };
  for (const char* name : {"other.json", "drive.json", "drive_a.json", "drive_a_n3_0.json", "drive_a_n3.json"}) {
    write_text(folder.path() / name, "{}");
    EXPECT_EQ(found(), name);
  }
}

TEST(ReplayPcapMetadata, WrongMetadataIsNamed) {
  const test::TemporaryFolder folder;
  std::filesystem::copy(clone_ouster() / "duplicate_id.pcap", folder.path() / "a.pcap");
  write_text(folder.path() / "a.json", "{\"lidar_mode\": \"1024x10\"}");
  const std::string message = open_error(folder.path() / "a.pcap");
  EXPECT_NE(message.find("a.json: beam_altitude_angles: found nothing, wanted 64 numbers"), std::string::npos)
      << message;
}

TEST(ReplayPcap, MetadataOfAnotherSensorRefusesEveryPacketByCause) {
  const test::TemporaryFolder folder;
  std::filesystem::copy(clone_ouster() / "duplicate_id.pcap", folder.path() / "a.pcap");
  std::filesystem::copy(clone_ouster() / "windowed_frame1_0.json", folder.path() / "a.json");
  Counts rejected;
  EXPECT_TRUE(read_capture(folder.path() / "a.pcap", rejected).empty());
  EXPECT_EQ(rejected, (Counts{{"bad_serial", 1}}));
}

TEST(ReplayPcap, LinkTypeThatWeDoNotReadIsNamed) {
  const test::TemporaryFolder folder;
  auto bytes = read_bytes(clone_ouster() / "duplicate_id.pcap");
  bytes[20] = 127;  // IEEE 802.11 radio
  write_bytes(folder.path() / "a.pcap", bytes);
  std::filesystem::copy(clone_ouster() / "duplicate_id.json", folder.path() / "a.json");
  EXPECT_NE(open_error(folder.path() / "a.pcap").find("found link type 127, wanted Ethernet (1)"), std::string::npos);
}

}  // namespace
}  // namespace lxd::source_pcap_test
