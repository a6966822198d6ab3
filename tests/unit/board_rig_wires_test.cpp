// SPDX-License-Identifier: Apache-2.0
// Where a live rig's bytes come in: read, checked and written again.
#include <gtest/gtest.h>

#include "board/rig_file.hpp"
#include "board/rig_text.hpp"

namespace lxd::board_rig_wires_test {
namespace {

constexpr const char* kLiveRig = R"(reference: imu
imu: {protocol: vectornav, baud_rate: 921600, device: /dev/serial/by-id/usb-imu}
lidar0: {address: 192.168.1.10, port: 7502, imu_port: 7503, multicast_group: 239.1.2.3, metadata: os.json,
         T_reference_sensor: [[1,0,0,0],[0,1,0,0],[0,0,1,0.1],[0,0,0,1]]}
lidar1: {model: livox, address: 192.168.1.11, port: 56301, host: 192.168.1.5}
wheel: {protocol: agilex, interface: can0}
gnss: {baud_rate: 38400, device: /dev/ttyACM0}
camera0: {resolution: [640, 480], intrinsics: [400, 400, 320, 240], device: /dev/video0, pixel_format: mjpeg,
          exposure_s: 0.005, stamp: trigger, readout_s: 0.002, controls: {trigger_mode: 1, gain: -7}}
pps: {chip: gpiochip1, line: 6, edge: clear, sensors: [lidar0, imu]}
triggers: {chip: gpiochip0, camera0: 5, edge: falling, to_exposure_s: 1e-4, delay_min_s: 0.005, delay_max_s: 0.03}
)";

void expect_wires(const Rig& rig) {
  EXPECT_EQ(rig.lidar0.wire.address, "192.168.1.10");
  EXPECT_EQ(rig.lidar0.wire.port, 7502U);
  EXPECT_EQ(rig.lidar0.wire.imu_port, 7503U);
  EXPECT_EQ(rig.lidar0.wire.multicast_group, "239.1.2.3");
  EXPECT_EQ(rig.lidar0.wire.metadata, "os.json");
  EXPECT_EQ(rig.lidar1->wire.port, 56301U);
  EXPECT_EQ(rig.lidar1->wire.host, "192.168.1.5");
  EXPECT_EQ(rig.imu->wire.device, "/dev/serial/by-id/usb-imu");
  EXPECT_EQ(rig.wheel->wire.interface, "can0");
  EXPECT_EQ(rig.gnss->wire.device, "/dev/ttyACM0");
  EXPECT_EQ(rig.gnss->baud_rate, 38400);
  const CameraWire& camera = rig.camera0->wire;
  EXPECT_EQ(camera.device, "/dev/video0");
  EXPECT_EQ(camera.pixel_format, "mjpeg");
  EXPECT_DOUBLE_EQ(camera.exposure_s, 0.005);
  EXPECT_TRUE(camera.by_triggers());
  EXPECT_DOUBLE_EQ(camera.readout_s, 0.002);
  EXPECT_EQ(camera.controls, (decltype(camera.controls){{"trigger_mode", 1}, {"gain", -7}}));
  EXPECT_EQ(rig.pps->gpio.chip, "gpiochip1");
  EXPECT_EQ(rig.pps->gpio.line, 6U);
  EXPECT_EQ(rig.pps->edge, "clear");
  EXPECT_EQ(rig.pps->sensors, (std::vector<std::string>{"lidar0", "imu"}));
  EXPECT_EQ(rig.triggers->camera0.chip, "gpiochip0");
  EXPECT_EQ(rig.triggers->camera0.line, 5U);
  EXPECT_EQ(rig.triggers->edge, "falling");
  EXPECT_DOUBLE_EQ(rig.triggers->to_exposure_s, 1e-4);
  EXPECT_DOUBLE_EQ(rig.triggers->delay_max_s, 0.03);
}

TEST(RigWires, AreReadAndWrittenAgain) {
  const RigFile file = parse_rig(kLiveRig, "rig.yaml");
  ASSERT_TRUE(file.ok()) << text_of(file.problems);
  expect_wires(file.rig);
  const std::string text = rig_text(file.rig);
  const RigFile again = parse_rig(text, "again.yaml");
  ASSERT_TRUE(again.ok()) << text_of(again.problems);
  expect_wires(again.rig);
  EXPECT_EQ(rig_text(again.rig), text);
}

// Given a rig without wires, then its text has none of their keys: it is a recording's.
TEST(RigWires, AreLeftOutWhereNotGiven) {
  const RigFile file = parse_rig(
      "lidar0: {}\nimu: {}\nwheel: {}\ngnss: {}\n"
      "camera0: {resolution: [8, 8], intrinsics: [4, 4, 4, 4]}\npps: {}\ntriggers: {}\n",
      "rig.yaml");
  const std::string text = rig_text(file.rig);
  for (const char* key :
       {" port:", "address:", "device:", "interface:", "metadata:", "chip:", "stamp:", "controls:", "pixel_format:"})
    EXPECT_EQ(text.find(key), std::string::npos) << key;
}

struct WrongWire {
  const char* text;
  const char* said;
};
class WrongWires : public testing::TestWithParam<WrongWire> {};

TEST_P(WrongWires, AreTold) {
  const RigFile file = parse_rig(GetParam().text, "rig.yaml");
  EXPECT_NE(text_of(file.problems).find(GetParam().said), std::string::npos) << text_of(file.problems);
}

INSTANTIATE_TEST_SUITE_P(
    Each, WrongWires,
    testing::Values(WrongWire{"lidar0: {address: 192.168.1}", "lidar0.address: found '192.168.1'"},
                    WrongWire{"lidar0: {address: 239.1.1.1}", "wanted an IPv4 address of one host"},
                    WrongWire{"lidar0: {multicast_group: 192.168.1.1}", "of a group"},
                    WrongWire{"lidar0: {port: 70000}", "lidar0.port"},
                    WrongWire{"lidar0: {port: 7502, imu_port: 7502}", "another port than that of the points"},
                    WrongWire{"lidar0: {prot: 7502}", "port"},
                    WrongWire{"lidar0: {}\nimu: {device: usb:199b}", "or usb:VENDOR:PRODUCT[:SERIAL]"},
                    WrongWire{"lidar0: {host: 300.1.1.1, port: 7}", "wanted an IPv4 address of one host"},
                    WrongWire{"lidar0: {host: 10.0.0.1}", "found it without port"},
                    WrongWire{"lidar0: {}\nimu: {device: ttyUSB0}", "wanted a path from / on"},
                    WrongWire{"lidar0: {}\nwheel: {interface: a-name-that-is-too-long}", "wheel.interface"},
                    WrongWire{"lidar0: {port: 7502}\nlidar1: {port: 7502}", "which lidar0 has too"},
                    WrongWire{"lidar0: {}\nimu: {device: /dev/a}\ngnss: {device: /dev/a}", "which imu has too"}));

constexpr const char* kCamera = "lidar0: {}\ncamera0: {resolution: [8, 8], intrinsics: [4, 4, 4, 4], ";

TEST_P(WrongWires, AreToldWithFileAndKey) {
  const RigFile file = parse_rig(GetParam().text, "rig.yaml");
  ASSERT_FALSE(file.problems.empty());
  EXPECT_EQ(text_of(file.problems).find("rig.yaml"), 0U) << text_of(file.problems);
}

std::string camera_with(const char* keys) { return std::string(kCamera) + keys + "}"; }

TEST(RigWires, MistakesOfACameraAreTold) {
  const std::vector<std::pair<const char*, const char*>> mistakes{
      {"device: video0", "rig.yaml:2: camera0.device: found 'video0', wanted a path from / on"},
      {"pixel_format: h264", "camera0.pixel_format: found 'h264', wanted grey or yuyv or rgb or mjpeg"},
      {"exposure_s: 5", "is it in milliseconds?"},
      {"stamp: middle", "camera0.stamp: found 'middle', wanted driver or exposure_start or frame_end or trigger"},
      {"controls: 7", "camera0.controls: found '7', wanted names of v4l2-ctl"},
      {"controls: {gain: high}", "camera0.controls.gain: found 'high', wanted a whole number"},
      {"stamp: trigger", "camera0.stamp: found trigger in a rig without a section triggers"}};
  for (const auto& [keys, said] : mistakes) {
    const RigFile file = parse_rig(camera_with(keys), "rig.yaml");
    EXPECT_NE(text_of(file.problems).find(said), std::string::npos) << text_of(file.problems);
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfTime, WrongWires,
    testing::Values(
        WrongWire{"lidar0: {}\npps: {device: pps0}", "pps.device: found 'pps0', wanted a path from / on"},
        WrongWire{"lidar0: {}\npps: {device: /dev/pps0, chip: gpiochip0, line: 3}", "pps.chip: found it beside device"},
        WrongWire{"lidar0: {}\npps: {chip: gpiochip0}", "pps.chip: found it without line"},
        WrongWire{"lidar0: {}\npps: {line: 5}", "pps.line: found it without chip"},
        WrongWire{"lidar0: {}\npps: {edge: rising}", "pps.edge: found 'rising', wanted assert or clear"},
        WrongWire{"lidar0: {}\npps: {sensors: [gnss]}", "pps.sensors: found 'gnss', wanted a list of"},
        WrongWire{"lidar0: {}\npps: {sensors: [imu]}", "pps.sensors: found imu, wanted sensors of this rig"},
        WrongWire{"lidar0: {}\nimu: {protocol: lidar0}\npps: {sensors: [imu]}", "goes by the LiDAR's clock"},
        WrongWire{"lidar0: {}\ntriggers: {camera0: 70000}", "triggers.camera0"},
        WrongWire{"lidar0: {}\ntriggers: {camera1: 7}", "triggers.camera1: unknown key"},
        WrongWire{"lidar0: {}\ntriggers: {delay_min_s: 0.1}", "wanted more than delay_min_s"},
        WrongWire{"lidar0: {}\npps: {chip: a, line: 1}\ntriggers: {chip: a, camera0: 1}", "which pps has too"}));

TEST(RigWires, TwoSensorsMayShareAPortWhenTheirAddressesDiffer) {
  const RigFile file =
      parse_rig("lidar0: {port: 7502, address: 10.0.0.1}\nlidar1: {port: 7502, address: 10.0.0.2}\n", "rig.yaml");
  EXPECT_TRUE(file.ok()) << text_of(file.problems);
}

}  // namespace
}  // namespace lxd::board_rig_wires_test
