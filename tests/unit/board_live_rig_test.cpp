// SPDX-License-Identifier: Apache-2.0
// Sensors that a live rig asks or sets up itself: an Ouster's metadata, a Livox, an IMU on USB.
#include <gtest/gtest.h>

#include "board/live_rig.hpp"
#include "board/livox_set_up.hpp"
#include "board/rig_file.hpp"

namespace lxd::board_live_rig_test {
namespace {

Rig rig_of(const std::string& yaml) {
  const RigFile file = parse_rig(yaml, "rig.yaml");
  EXPECT_TRUE(file.ok()) << text_of(file.problems);
  return file.rig;
}

// A device that hands over one chunk a read.
class OneChunk final : public Device {
 public:
  explicit OneChunk(Chunk chunk) : chunk_(chunk) {}
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] int fd() const override { return 1000; }
  void read(ChunkSink& sink) override { sink.take(chunk_); }
  void tend(RigTime) override { ++tended; }
  [[nodiscard]] const std::string& trouble() const override { return trouble_; }
  [[nodiscard]] const DeviceCounts& counts() const override { return counts_; }
  int tended = 0;

 private:
  Chunk chunk_;
  std::string name_ = "one", trouble_ = "as it is";
  DeviceCounts counts_;
};

TEST(LiveRig, AsksAnOusterThatHasAnAddressAndNoMetadata) {
  const auto live = make_live(rig_of("lidar0: {address: 127.0.0.1, port: 7502}"), ".");
  ASSERT_FALSE(live) << "nobody serves HTTP here";
  EXPECT_EQ(live.error().message.find("lidar0.metadata: http://127.0.0.1:80/api/v1/sensor/metadata: "), 0U)
      << live.error().message;
}

TEST(LiveRig, ALivoxWithoutAHostIsSetUpByOthers) {
  const auto live = make_live(rig_of("lidar0: {model: livox, port: 56301}"), ".");
  ASSERT_TRUE(live) << live.error().message;
  std::vector<std::unique_ptr<Device>> devices;
  set_up_livox(live->lidars, devices);
  EXPECT_TRUE(devices.empty());
}

TEST(LiveRig, ALivoxWithAHostHasItsControlAndItsPortHandsOverAsBefore) {
  const auto live = make_live(
      rig_of("lidar0: {model: livox, address: 192.168.1.12, host: 192.168.1.5, port: 56301, imu_port: 56401}"), ".");
  ASSERT_TRUE(live) << live.error().message;
  Chunk chunk;
  chunk.origin.destination_port = 56301;
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(std::make_unique<OneChunk>(chunk));
  const auto& one = static_cast<const OneChunk&>(*devices.front());
  set_up_livox(live->lidars, devices);
  ASSERT_EQ(devices.size(), 2U);
  EXPECT_EQ(devices[1]->name(), "livox control");
  EXPECT_EQ(devices[0]->name(), "one");
  EXPECT_EQ(devices[0]->trouble(), "as it is");
  EXPECT_EQ(devices[0]->fd(), 1000);
  devices[0]->tend(RigTime::from_ns(0));
  EXPECT_EQ(one.tended, 1);
}

TEST(LiveRig, AnImuMayBeAUsbDevice) {
  Rig rig = rig_of("lidar0: {model: livox, port: 56301}\nimu: {device: 'usb:199b:3065:42', protocol: microstrain}");
  const auto live = make_live(rig, ".");
  ASSERT_TRUE(live) << live.error().message;
  EXPECT_TRUE(live->sensors.imu);
}

}  // namespace
}  // namespace lxd::board_live_rig_test
