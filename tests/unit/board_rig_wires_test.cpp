// SPDX-License-Identifier: Apache-2.0
// Where a live rig's bytes come in: read, checked and written again.
#include <gtest/gtest.h>

#include "board/rig_file.hpp"
#include "board/rig_text.hpp"

namespace lxd {
namespace {

constexpr const char* kLiveRig = R"(reference: imu
imu: {protocol: vectornav, baud_rate: 921600, device: /dev/serial/by-id/usb-imu}
lidar0: {address: 192.168.1.10, port: 7502, imu_port: 7503, multicast_group: 239.1.2.3, metadata: os.json,
         T_reference_sensor: [[1,0,0,0],[0,1,0,0],[0,0,1,0.1],[0,0,0,1]]}
lidar1: {model: livox, address: 192.168.1.11, port: 56301, host: 192.168.1.5}
wheel: {protocol: agilex, interface: can0}
gnss: {baud_rate: 38400, device: /dev/ttyACM0}
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
  const RigFile file = parse_rig("lidar0: {}\nimu: {}\nwheel: {}\ngnss: {}\n", "rig.yaml");
  const std::string text = rig_text(file.rig);
  for (const char* key : {" port:", "address:", "device:", "interface:", "metadata:"})
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

TEST(RigWires, TwoSensorsMayShareAPortWhenTheirAddressesDiffer) {
  const RigFile file =
      parse_rig("lidar0: {port: 7502, address: 10.0.0.1}\nlidar1: {port: 7502, address: 10.0.0.2}\n", "rig.yaml");
  EXPECT_TRUE(file.ok()) << text_of(file.problems);
}

}  // namespace
}  // namespace lxd
