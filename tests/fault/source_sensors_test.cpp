// SPDX-License-Identifier: Apache-2.0
// Captures of more than one Ouster sensor, and of one that restarts: sweeps are of one sensor, and time goes on.
#include <cstdio>

#include "drivers/replay/ouster_pcap.hpp"
#include "tests/support/replay_ouster.hpp"

namespace lxd::source_sensors_test {
namespace {

using namespace replay_test;

constexpr std::uint16_t kFirst = 0x0101, kSecond = 0x0102;  // senders
constexpr std::uint16_t kColumns = 64, kColumnsOfAPacket = 16;
constexpr std::uint32_t kPackets = kColumns / kColumnsOfAPacket;
constexpr std::uint64_t kTurn_ns = 100'000'000;

class OusterSensors : public testing::Test {
 protected:
  // Packet number `part` of a frame whose ranges say which sensor it is of.
  void send(std::uint16_t from, std::uint16_t port, std::uint32_t frame, std::uint32_t part, std::uint64_t begin_ns) {
    const auto column = static_cast<std::uint16_t>(part * kColumnsOfAPacket);
    sent_.push_back(
        {made_packet(metadata_, frame, column, begin_ns + 1'000'000U * column, from == kFirst ? 5000 : 9000), from,
         port});
  }
  void send_frame(std::uint16_t from, std::uint16_t port, std::uint32_t frame, std::uint64_t begin_ns) {
    for (std::uint32_t part = 0; part < kPackets; ++part) send(from, port, frame, part, begin_ns);
  }
  // Three turns of both, packet by packet in turn, the first sensor's first.
  void send_both(std::uint16_t first_port, std::uint16_t second_port) {
    for (std::uint32_t frame = 1; frame <= 3; ++frame) {
      for (std::uint32_t part = 0; part < kPackets; ++part) {
        send(kFirst, first_port, frame, part, frame * kTurn_ns);
        send(kSecond, second_port, frame, part, frame * kTurn_ns);
      }
    }
  }

  // As opening a capture by its path does.
  void read() {
    const auto bytes = made_pcap(sent_, 600);
    auto searched = opened(bytes), replayed = opened(bytes);
    const auto stream = find_ouster_stream(std::move(searched.second), metadata_);
    const auto source = make_ouster_source(std::move(replayed.second), metadata_, stream);
    sweeps_ = read_all(*source, 1000);
    rejected_ = source->rejected();
  }
  void expect_three_sweeps_at(double range_m) const {
    ASSERT_EQ(sweeps_.size(), 3U);
    for (const OwnedSweep& sweep : sweeps_) {
      EXPECT_EQ(sweep.points.size(), std::size_t{kColumns} * metadata_.format.pixels_per_column);
      for (const LidarPoint& p : sweep.points) {
        ASSERT_NEAR(std::hypot(p.x_m, p.y_m, p.z_m), range_m, 1e-3);
      }
    }
  }

  OusterMetadata metadata_ = made_metadata("LEGACY", kColumns);
  std::vector<SentPacket> sent_;
  std::vector<OwnedSweep> sweeps_;
  Counts rejected_;

 private:
  using Bytes = std::vector<std::uint8_t>;
  // libpcap reads from the bytes, which go with it.
  static std::pair<std::unique_ptr<Bytes>, PcapFile> opened(const Bytes& bytes) {
    auto own = std::make_unique<Bytes>(bytes);
    auto pcap = PcapFile::from_stream(fmemopen(own->data(), own->size(), "rb"), "made.pcap");
    return {std::move(own), std::move(*pcap)};
  }
};

TEST_F(OusterSensors, OnOnePortTheFirstToSendIsRead) {
  metadata_.lidar_port = 7502;
  send_both(7502, 7502);
  read();
  expect_three_sweeps_at(5);
  EXPECT_EQ(rejected_, (Counts{{"other_sensor", 3 * kPackets}}));
}

TEST_F(OusterSensors, OnTwoPortsTheMetadatasIsRead) {
  metadata_.lidar_port = 7504;
  send_both(7502, 7504);
  read();
  expect_three_sweeps_at(9);
  EXPECT_EQ(rejected_, (Counts{{"other_sensor", 3 * kPackets}}));
}

TEST_F(OusterSensors, OneSensorsTwoPortsAreTwoStreams) {
  metadata_.lidar_port = 7504;
  for (std::uint32_t frame = 1; frame <= 3; ++frame) {
    send_frame(kFirst, 7502, frame, frame * kTurn_ns);
    send_frame(kFirst, 7504, frame, frame * kTurn_ns);
  }
  read();
  expect_three_sweeps_at(5);
  EXPECT_EQ(rejected_, (Counts{{"other_sensor", 3 * kPackets}}));
}

TEST_F(OusterSensors, OnForwardedPortsTheFirstToSendIsRead) {
  metadata_.lidar_port = 7502;
  send_both(40001, 40002);
  read();
  expect_three_sweeps_at(5);
}

TEST_F(OusterSensors, PortThatTheMetadataDoesNotSayIsTheFirstToSend) {
  send_both(7502, 7504);
  read();
  expect_three_sweeps_at(5);
}

// The second one's port only comes after about a second: by then the first one's is what the capture is of.
TEST_F(OusterSensors, PortThatComesLateIsNotWaitedFor) {
  metadata_.lidar_port = 7504;
  for (std::uint32_t frame = 1; frame <= 251; ++frame) send_frame(kFirst, 7502, frame, frame * kTurn_ns);
  send_frame(kSecond, 7504, 252, 252 * kTurn_ns);
  read();
  EXPECT_EQ(sweeps_.size(), 251U);
  EXPECT_EQ(rejected_, (Counts{{"other_sensor", kPackets}}));
}

// Given no search at opening, when packets of two come, then the first is the sensor.
TEST_F(OusterSensors, SourceOverOpenPartsKeepsToTheFirst) {
  metadata_.lidar_port = 7504;
  send_both(7502, 7504);
  auto bytes = made_pcap(sent_, 600);
  auto pcap = PcapFile::from_stream(fmemopen(bytes.data(), bytes.size(), "rb"), "made.pcap");
  const auto source = make_ouster_source(std::move(*pcap), metadata_);
  sweeps_ = read_all(*source, 1000);
  expect_three_sweeps_at(5);
}

// Given a sensor on its own oscillator, when it restarts, then frames and time begin anew and two turns are lost.
TEST_F(OusterSensors, RestartIsOneStepAndTimeGoesOn) {
  for (std::uint32_t turn = 0; turn < 10; ++turn) send_frame(kFirst, 7502, 500 + turn, (900 + turn) * kTurn_ns);
  for (std::uint32_t turn = 0; turn < 10; ++turn) send_frame(kFirst, 7502, 1 + turn, (50 + turn) * kTurn_ns);
  read();
  EXPECT_EQ(rejected_, (Counts{{"clock_step", 1}, {"time_backwards", 2}}));
  ASSERT_EQ(sweeps_.size(), 18U);
  for (std::size_t i = 0; i < sweeps_.size(); ++i) {
    const std::size_t turn = i < 10 ? i : i + 2;
    EXPECT_EQ(sweeps_[i].header.begin.ns(), static_cast<std::int64_t>(turn * kTurn_ns)) << i;
    EXPECT_EQ(sweeps_[i].header.sequence, i);
  }
}

// Given two real turns of one sensor on its own, when a second sensor's come between them, then the sweep is the same.
TEST(OusterTwoSensors, RealPacketsOfAnotherSenderChangeNothing) {
  const auto name = [](const char* ending) {
    return clone_ouster() / (std::string("OS-1-32-G_v2.1.1_1024x10") + ending);
  };
  const OusterMetadata metadata = must_read_metadata(name(".json"));
  const auto packets = datagrams(name(".pcap"), metadata.format.packet_bytes());
  std::vector<SentPacket> sent;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    sent.push_back({packets[i], kFirst});
    sent.push_back({packets[packets.size() - 1 - i], kSecond});
  }
  const test::TemporaryFolder folder;
  write_bytes(folder.path() / "a.pcap", made_pcap(sent, 1480));
  std::filesystem::copy(name(".json"), folder.path() / "a.json");
  const auto source = must_open(folder.path() / "a.pcap");
  const auto mixed = read_all(*source);
  const auto alone = read_all(*must_open(name(".pcap")));
  ASSERT_EQ(mixed.size(), alone.size());
  ASSERT_EQ(mixed[0].points.size(), alone[0].points.size());
  EXPECT_EQ(mixed[0].points.back().x_m, alone[0].points.back().x_m);
  EXPECT_EQ(source->rejected().at("other_sensor"), packets.size());
}

}  // namespace
}  // namespace lxd::source_sensors_test
