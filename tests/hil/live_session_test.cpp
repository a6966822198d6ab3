// SPDX-License-Identifier: Apache-2.0
// What `lxd-slam record` and `lxd-slam run` made of the guest's wires, two rigs at once, against what was played
// (guest-init, LXD_HIL_SESSIONS): every datagram, frame and byte, and the samples that a replay makes of them.
#include <array>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "board/rig_file.hpp"
#include "board/wheel_table.hpp"
#include "drivers/replay/camera_folder.hpp"
#include "drivers/replay/gpio_log.hpp"
#include "drivers/replay/imu_source.hpp"
#include "drivers/replay/open.hpp"
#include "drivers/replay/pps_log.hpp"
#include "drivers/replay/unfinished_recording.hpp"
#include "drivers/replay/wheel_source.hpp"
#include "tests/hil/played_recording.hpp"

namespace lxd::live_session_test {
namespace {

namespace fs = std::filesystem;

constexpr double kBaudRate = 115'200;

nlohmann::json json_of(const fs::path& file) { return nlohmann::json::parse(std::ifstream(file)); }

// A rig's name: that of its file below rigs/.
class HilSession : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("LXD_HIL_SESSIONS");
    if (folder == nullptr) GTEST_SKIP() << "no recorded session";
    played_ = fs::path(folder) / "played";
    recorded_ = fs::path(folder) / (std::string("record-") + GetParam());
    run_ = fs::path(folder) / (std::string("run-") + GetParam());
    outside_ = json_of(fs::path(folder) / "outside.json");
  }
  [[nodiscard]] bool is_serial() const { return std::string_view(GetParam()) == "serial"; }

  fs::path played_, recorded_, run_;
  nlohmann::json outside_;  // what the guest's outside has sent, by session
};

struct PointsOf {
  std::vector<std::size_t> sweeps;  // points of each
  std::vector<std::array<float, 4>> points;
  bool operator==(const PointsOf&) const = default;
};

PointsOf points_of(const fs::path& recording) {
  constexpr std::size_t kSweepMax = 65'536;
  auto source = open_recording(recording, {});
  if (!source) throw std::runtime_error(source.error().message);
  std::vector<LidarPoint> storage(kSweepMax);
  Sweep sweep;
  sweep.storage = storage;
  PointsOf all;
  for (; (*source)->next(sweep).value(); sweep.count = 0) {
    all.sweeps.push_back(sweep.count);
    for (const LidarPoint& p : sweep.points()) all.points.push_back({p.x_m, p.y_m, p.z_m, p.intensity});
  }
  return all;
}

std::vector<ImuSample> inertial_of(const fs::path& recording) {
  auto source = open_imu_source(recording, ImuProtocol::kVectorNav, kBaudRate);
  if (!source) throw std::runtime_error(source.error().message);
  std::vector<ImuSample> all;
  for (ImuSample sample; (*source)->next(sample);) all.push_back(sample);
  EXPECT_TRUE((*source)->rejected().empty());
  return all;
}

std::vector<WheelSample> wheels_of(const fs::path& recording) {
  const RigFile file = load_rig((recording / "rig.yaml").string());
  if (!file.ok()) throw std::runtime_error(text_of(file.problems));
  const auto messages = wheel_messages(*file.rig.wheel);
  auto source = open_wheel_source(recording, messages, wheel_decoder_config(*file.rig.wheel, messages));
  if (!source) throw std::runtime_error(source.error().message);
  std::vector<WheelSample> all;
  for (WheelSample sample; (*source)->next(sample);) all.push_back(sample);
  return all;
}

std::vector<std::uint8_t> line_of(const std::vector<hil::Piece>& pieces) {
  std::vector<std::uint8_t> all;
  for (const hil::Piece& piece : pieces) all.insert(all.end(), piece.bytes.begin(), piece.bytes.end());
  return all;
}

TEST_P(HilSession, RecordLosesNothing) {
  EXPECT_FALSE(is_unfinished(recorded_));
  const nlohmann::json summary = json_of(recorded_ / "recording.json");
  for (const auto& [name, sensor] : summary["sensors"].items()) {
    EXPECT_GT(sensor["chunks"], 0) << name;
    EXPECT_EQ(sensor["no_room"], 0) << name;
    EXPECT_EQ(sensor["not_written"], 0) << name;
  }
  for (const auto& [name, device] : summary["devices"].items())
    for (const char* const cause : {"departures", "kernel_overflow", "cut"})
      EXPECT_EQ(device.value(cause, 0), 0) << name << ": " << cause;
}

TEST_P(HilSession, TheSameDatagramsAndTheSamePoints) {
  const auto played = hil::datagrams_of(played_ / "lidar0.pcap"), found = hil::datagrams_of(recorded_ / "lidar0.pcap");
  ASSERT_EQ(found.size(), played.size());
  for (std::size_t i = 0; i < played.size(); ++i) ASSERT_EQ(found[i].bytes, played[i].bytes) << "datagram " << i;
  const PointsOf wanted = points_of(played_);
  ASSERT_GT(wanted.sweeps.size(), 50U);
  EXPECT_TRUE(points_of(recorded_) == wanted);
}

TEST_P(HilSession, TheSameBytesAndTheSameInertialSamples) {
  EXPECT_EQ(line_of(hil::serial_of(recorded_ / kImuSerialFile)), line_of(hil::serial_of(played_ / kImuSerialFile)));
  const auto wanted = inertial_of(played_), found = inertial_of(recorded_);
  ASSERT_GT(wanted.size(), 500U);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].sensor_ns, wanted[i].sensor_ns);
    EXPECT_EQ(found[i].gyro_radps, wanted[i].gyro_radps);
    EXPECT_EQ(found[i].accel_mps2, wanted[i].accel_mps2);
  }
}

TEST_P(HilSession, TheSameFramesAndTheSameWheelSamples) {
  const auto wanted = wheels_of(played_), found = wheels_of(recorded_);
  ASSERT_GT(wanted.size(), 200U);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].speed_mps, wanted[i].speed_mps, 1e-12);
    EXPECT_NEAR(found[i].yaw_rate_radps, wanted[i].yaw_rate_radps, 1e-12);
  }
  const auto frames = hil::frames_of(recorded_ / kCanLogFile);
  auto sent = hil::frames_of(played_ / kCanLogFile);
  std::erase_if(sent, [&](const CanFrame& frame) {
    return std::ranges::none_of(frames, [&](const CanFrame& kept) { return kept.id == frame.id; });
  });
  ASSERT_EQ(frames.size(), sent.size());
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i].data, sent[i].data) << "frame " << i;
}

// Frames are of a test picture that moves: a moment more or less of it is the camera's own affair. Pulses and triggers
// are counted by who drove the lines.
TEST_P(HilSession, CameraPulsesAndTriggers) {
  if (!is_serial()) GTEST_SKIP() << "the other rig has them";
  auto camera = CameraFolder::open(recorded_ / "camera0");
  ASSERT_TRUE(camera) << camera.error().message;
  const nlohmann::json summary = json_of(recorded_ / "recording.json");
  std::size_t frames = 0;
  RigTime last;
  for (CameraImage image; camera->next(image); last = image.stamp, ++frames) {
    EXPECT_EQ(image.pixels.width, 320);
    EXPECT_EQ(image.pixels.height, 180);
    EXPECT_TRUE(frames == 0 || image.stamp > last) << frames;
  }
  EXPECT_EQ(frames, summary["sensors"]["camera0"]["chunks"].get<std::size_t>());
  EXPECT_TRUE(camera->rejected().empty());
  EXPECT_GT(frames, 10U);

  const auto driven = outside_["record"]["pulses"].get<std::size_t>();
  const auto pulses = read_pps_log(recorded_ / kPpsLogFile);
  ASSERT_TRUE(pulses) << pulses.error().message;
  EXPECT_EQ(pulses->edges.size(), driven);
  EXPECT_EQ(pulses->lost, 0U);
  const auto triggers = read_gpio_edges(recorded_ / kGpioLogFile, kCameraLine, true);
  ASSERT_TRUE(triggers) << triggers.error().message;
  EXPECT_EQ(triggers->size(), driven);
}

// The emulated machine is slow: which sweeps wait too long is its own affair, what its devices hear is not.
TEST_P(HilSession, RunHearsEverythingAndGivesAPath) {
  const nlohmann::json report = json_of(run_ / "report.json");
  EXPECT_GT(report["sweeps"], 0);
  EXPECT_GE(report["sweeps"].get<std::uint64_t>() + report["dropped"].value("late", 0U), 50U);
  EXPECT_EQ(report["rt_allocations"], 0);
  std::map<std::string, std::uint64_t> heard;
  for (const auto& [name, device] : report["live"]["devices"].items()) {
    heard[name.substr(0, name.find(' '))] += device.value("chunks", 0U);
    EXPECT_EQ(device.value("departures", 0), 0) << name;
    EXPECT_EQ(device.value("kernel_overflow", 0), 0) << name;
  }
  EXPECT_EQ(heard["udp"], hil::datagrams_of(played_ / "lidar0.pcap").size());
  EXPECT_TRUE(fs::file_size(run_ / "odometry.tum") > 0);
}

INSTANTIATE_TEST_SUITE_P(TwoRigsAtOnce, HilSession, testing::Values("serial", "usb"),
                         [](const auto& rig) { return std::string(rig.param); });

}  // namespace
}  // namespace lxd::live_session_test
