// SPDX-License-Identifier: Apache-2.0
// `lxd-slam record`: what is played onto the wires is what the recording replays, through pulled cables, kills and full
// disks.
#include <csignal>

#include "drivers/gnss/nmea_parser.hpp"
#include "drivers/replay/imu_log.hpp"
#include "drivers/replay/open.hpp"
#include "drivers/replay/unfinished_recording.hpp"
#include "tests/support/emulated.hpp"
#include "tests/support/run_result.hpp"
#include "tests/support/wire_player.hpp"

namespace lxd::test::live_record_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSmallRig = R"yaml(
world: building
motion: {carrier: handheld, rest_s: 1}
duration_s: 3
lidar0: {model: ouster, product: OS0, beams: 32, columns: 512}
lidar1: {model: livox}
imu: {protocol: vectornav, update_rate: 200}
gnss: {rate_hz: 5}
)yaml";

constexpr double kEverything_s = 1e9;

// In the order of the file, of each port: nothing tells which of two ports was heard first. Points first, which are
// longer.
using Payloads = std::vector<std::vector<std::uint8_t>>;
Payloads payloads(const fs::path& pcap, bool points) {
  constexpr std::size_t kImuMax = 64;
  Payloads all;
  for (auto& played : datagrams_of(pcap, ""))
    if ((played.bytes.size() > kImuMax) == points) all.push_back(std::move(played.bytes));
  return all;
}
Payloads payloads(const fs::path& pcap) {
  Payloads all = payloads(pcap, true), imu = payloads(pcap, false);
  std::ranges::move(imu, std::back_inserter(all));
  return all;
}

std::vector<ImuSample> imu_samples(const fs::path& recording) {
  std::vector<ImuSample> samples;
  auto log = ImuLog::open(recording / "imu.serial", ImuProtocol::kVectorNav, 115200);
  ImuSample sample;
  while (log.ok() && log->next(sample)) samples.push_back(sample);
  return samples;
}

std::vector<GnssFix> fixes(const fs::path& recording) {
  std::vector<GnssFix> all;
  NmeaParser parser;
  for (const auto& line : sentences_of(recording / "gnss.nmea"))
    parser.feed(line.bytes, line.t, [&](const GnssFix& fix) { all.push_back(fix); });
  return all;
}

std::size_t points_in(const fs::path& recording) {
  auto source = open_recording(recording, {});
  std::vector<LidarPoint> storage(65'536);
  Sweep sweep;
  sweep.storage = storage;
  std::size_t points = 0;
  for (; source.ok() && (*source)->next(sweep).value(); sweep.count = 0) points += sweep.count;
  return points;
}

class LiveRecord : public testing::Test {
 protected:
  void SetUp() override {
    if (emulated()) GTEST_SKIP() << kNoSerialLine;
    write_file(folder_ / "scenario.yaml", kSmallRig);
    const Ended made =
        lxd_slam(fmt::format("simulate {} --out {}", (folder_ / "scenario.yaml").string(), original_.string()));
    EXPECT_EQ(made.status, 0) << made.text;
    player_.emplace(original_, folder_);
  }

  [[nodiscard]] std::string command() const {
    return fmt::format("record --rig {} --out {}", player_->rig_file().string(), recording_.string());
  }
  // Whether the program listens: it has made its folder's last file.
  void wait_until_it_listens() const {
    for (int i = 0; i < 1000 && !exists(recording_ / "gnss.nmea"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // serial devices are opened by then
  }
  [[nodiscard]] nlohmann::json summary() const {
    return nlohmann::json::parse(read_file(recording_ / "recording.json"));
  }

  TemporaryFolder folder_;
  fs::path original_ = folder_ / "original", recording_ = folder_ / "recording";
  std::optional<WirePlayer> player_;
};

// Given a rig of two LiDARs, IMU and GNSS on their wires, when it is recorded and stopped, then the recording is whole,
// and gives the same datagrams, points, samples and fixes as what was played.
TEST_F(LiveRecord, HoldsWhatWasOnTheWires) {
  Program program(command());
  wait_until_it_listens();
  player_->play(0, kEverything_s, 2);
  program.signal(SIGINT);
  const Ended ended = program.wait();
  ASSERT_EQ(ended.status, 0) << ended.text;
  EXPECT_FALSE(is_unfinished(recording_));
  EXPECT_TRUE(payloads(recording_ / "lidar0.pcap") == payloads(original_ / "lidar0.pcap"));
  EXPECT_TRUE(payloads(recording_ / "lidar1.pcap") == payloads(original_ / "lidar1.pcap"));
  EXPECT_EQ(points_in(recording_), points_in(original_));

  const auto samples = imu_samples(recording_), wanted = imu_samples(original_);
  ASSERT_EQ(samples.size(), wanted.size());
  ASSERT_GT(samples.size(), 500U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].sensor_ns, wanted[i].sensor_ns);
    EXPECT_EQ(samples[i].gyro_radps, wanted[i].gyro_radps);
    EXPECT_EQ(samples[i].accel_mps2, wanted[i].accel_mps2);
  }
  const auto found = fixes(recording_), sent = fixes(original_);
  ASSERT_EQ(found.size(), sent.size());
  ASSERT_GT(found.size(), 5U);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].latitude_deg, sent[i].latitude_deg);

  EXPECT_EQ(summary()["sensors"]["lidar0"]["chunks"], player_->sent("lidar0"));
  EXPECT_EQ(summary()["sensors"]["lidar0"]["no_room"], 0);
  const Ended checked = lxd_slam(fmt::format("check {}", (recording_ / "rig.yaml").string()));
  EXPECT_EQ(checked.status, 0) << checked.text;
}

// Given a cable that is pulled and put in again, then both are events, and what came before and after is there.
TEST_F(LiveRecord, GoesOnWhenACableIsPulled) {
  Program program(command() + " --quiet");
  wait_until_it_listens();
  player_->play(0, 1);
  player_->imu().pull();
  player_->play(1, 1.5);
  player_->imu().plug();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  player_->play(1.5, kEverything_s);
  program.signal(SIGTERM);
  const Ended ended = program.wait();
  ASSERT_EQ(ended.status, 0) << ended.text;
  EXPECT_TRUE(ended.says("imu: away:")) << ended.text;
  EXPECT_TRUE(ended.says("imu: back")) << ended.text;
  EXPECT_TRUE(payloads(recording_ / "lidar0.pcap") == payloads(original_ / "lidar0.pcap"));
  const std::size_t samples = imu_samples(recording_).size(), all = imu_samples(original_).size();
  EXPECT_GT(samples, all / 2);
  EXPECT_LT(samples, all * 9 / 10);
  EXPECT_EQ(summary()["devices"][(folder_ / "imu").string()]["departure"], 1);
}

// The most that the program said was written, in MiB.
double acknowledged_mib(const std::string& text) {
  double most = 0;
  for (std::size_t at = text.find("written "); at != std::string::npos; at = text.find("written ", at + 1))
    most = std::max(most, std::stod(text.substr(at + 8)));
  return most;
}

// Given a recorder that is killed, then what it said was written is there in whole records, and the folder says that it
// is unfinished.
TEST_F(LiveRecord, LosesNothingThatItAcknowledgedWhenKilled) {
  Program program(command());
  wait_until_it_listens();
  player_->play(0, kEverything_s, 0.5);  // long enough for a line of progress
  program.signal(SIGKILL);
  const Ended ended = program.wait();
  const double acknowledged = acknowledged_mib(ended.text);
  ASSERT_GT(acknowledged, 1) << ended.text;
  double there = 0;
  for (const char* name : {"lidar0.pcap", "lidar1.pcap", "imu.serial", "gnss.nmea"})
    there += static_cast<double>(fs::file_size(recording_ / name));
  EXPECT_GE(there / (1024 * 1024) + 0.05, acknowledged);  // the line has one decimal
  EXPECT_TRUE(is_unfinished(recording_));
  const Payloads found = payloads(recording_ / "lidar0.pcap", true), sent = payloads(original_ / "lidar0.pcap", true);
  ASSERT_GT(found.size(), sent.size() / 2);
  EXPECT_TRUE(std::equal(found.begin(), found.end(), sent.begin()));
}

// Given a disk that is full for the LiDARs' files, then those end behind a whole record, it is said which and why, the
// others go on, and the exit status says that not all was written.
TEST_F(LiveRecord, EndsTheFilesThatHaveNoRoomAndNoOthers) {
  Program program(command() + " --quiet", {.file_bytes = 1'000'000});
  wait_until_it_listens();
  player_->play(0, kEverything_s, 2);
  program.signal(SIGINT);
  const Ended ended = program.wait();
  EXPECT_EQ(ended.status, 1);
  EXPECT_TRUE(ended.says("lidar0.pcap: cannot be written: File too large")) << ended.text;
  EXPECT_TRUE(is_unfinished(recording_));
  EXPECT_EQ(imu_samples(recording_).size(), imu_samples(original_).size());
  const Payloads found = payloads(recording_ / "lidar0.pcap", true), sent = payloads(original_ / "lidar0.pcap", true);
  ASSERT_GT(found.size(), 5U);
  EXPECT_TRUE(std::equal(found.begin(), found.end(), sent.begin()));
  EXPECT_EQ(
      summary()["sensors"]["lidar0"]["chunks"].get<std::size_t>(),
      payloads(recording_ / "lidar0.pcap").size() + summary()["sensors"]["lidar0"]["not_written"].get<std::size_t>());
}

TEST_F(LiveRecord, NeverReplacesAFolderThatHoldsSomething) {
  fs::create_directories(recording_);
  write_file(recording_ / "lidar0.pcap", "precious");
  const Ended ended = lxd_slam(command());
  EXPECT_EQ(ended.status, 2);
  EXPECT_TRUE(ended.says("wanted a new or empty one")) << ended.text;
  EXPECT_EQ(read_file(recording_ / "lidar0.pcap"), "precious");
}

TEST_F(LiveRecord, SaysWhatTheRigFileLacks) {
  const Ended ended =
      lxd_slam(fmt::format("record --rig {} --out {}", (original_ / "rig.yaml").string(), recording_.string()));
  EXPECT_EQ(ended.status, 2);
  EXPECT_TRUE(ended.says("lidar0.metadata: found nothing, wanted the JSON file")) << ended.text;
  EXPECT_FALSE(exists(recording_));
}

}  // namespace
}  // namespace lxd::test::live_record_test
