// SPDX-License-Identifier: Apache-2.0
// The doctor, asked for a rig: which of the devices that its file names are there.
#include <gtest/gtest.h>

#include "board/doctor/rig_devices.hpp"
#include "board/rig_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::board_doctor_rig_test {
namespace {

class DoctorOfARig : public testing::Test {
 protected:
  void put(const std::string& path) const {
    const std::filesystem::path file = machine_ / path;
    std::filesystem::create_directories(file.parent_path());
    test::write_file(file, "");
  }
  // A line a finding.
  [[nodiscard]] std::vector<std::string> told(const std::string& yaml) const {
    const RigFile file = parse_rig("lidar0: {}\n" + yaml, "rig.yaml");
    EXPECT_TRUE(file.ok()) << text_of(file.problems);
    std::vector<std::string> lines;
    for (const Finding& finding : diagnose_devices(file.rig, machine_.path())) {
      EXPECT_EQ(finding.mend.empty(), finding.verdict == Verdict::good) << finding.subject;
      lines.push_back((finding.verdict == Verdict::good ? "+ " : "- ") + finding.subject + ": " + finding.found);
    }
    return lines;
  }
  test::TemporaryFolder machine_;
};

constexpr const char* kRig = R"(
imu: {device: /dev/serial/by-id/usb-imu}
gnss: {device: /dev/ttyACM0}
wheel: {interface: can0}
camera0: {resolution: [8, 8], intrinsics: [8, 8, 4, 4], device: /dev/video0}
pps: {device: /dev/pps0}
triggers: {chip: gpiochip1, camera0: 5}
)";

TEST_F(DoctorOfARig, FindsWhatIsThere) {
  for (const char* path :
       {"dev/serial/by-id/usb-imu", "dev/ttyACM0", "sys/class/net/can0", "dev/video0", "dev/pps0", "dev/gpiochip1"})
    put(path);
  EXPECT_EQ(told(kRig), (std::vector<std::string>{"+ imu: /dev/serial/by-id/usb-imu", "+ gnss: /dev/ttyACM0",
                                                  "+ wheel: can0", "+ camera0: /dev/video0", "+ pps: /dev/pps0",
                                                  "+ triggers: /dev/gpiochip1, line 5"}));
}

TEST_F(DoctorOfARig, SaysWhatIsNot) {
  EXPECT_EQ(told(kRig), (std::vector<std::string>{
                            "- imu: /dev/serial/by-id/usb-imu: No such file or directory; wanted a serial device",
                            "- gnss: /dev/ttyACM0: No such file or directory; wanted a serial device",
                            "- wheel: no network interface can0",
                            "- camera0: /dev/video0: No such file or directory; wanted a V4L2 camera",
                            "- pps: /dev/pps0: No such file or directory; wanted a pulse source",
                            "- triggers: /dev/gpiochip1: No such file or directory; wanted a GPIO chip, line 5"}));
}

TEST_F(DoctorOfARig, LooksForNothingThatHasNoWireHere) {
  EXPECT_TRUE(told("imu: {device: 'usb:199b:3065'}\npps: {}\ntriggers: {}\nwheel: {}").empty());
  EXPECT_EQ(told("pps: {chip: pl061, line: 6}"),
            (std::vector<std::string>{"- pps: a chip labelled pl061: not looked for"}));
}

}  // namespace
}  // namespace lxd::board_doctor_rig_test
