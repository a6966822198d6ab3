// SPDX-License-Identifier: Apache-2.0
// Each device against the real kernel's interface, in a guest that has them all (tests/hil/run): CAN, GPIO, PPS, a USB
// serial line, a camera, USB bulk transfers.
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include "drivers/camera/v4l2_camera.hpp"
#include "drivers/device/can_socket.hpp"
#include "drivers/device/libusb_bulk.hpp"
#include "drivers/device/serial_port.hpp"
#include "drivers/device/usb_bulk.hpp"
#include "drivers/imu/vectornav_parser.hpp"
#include "drivers/sync/gpio_edges.hpp"
#include "drivers/sync/libgpiod_line.hpp"
#include "drivers/sync/pps_source.hpp"
#include "tests/hil/guest_wires.hpp"

namespace lxd::kernel_devices_test {
namespace {

using hil::drive;
using hil::Kept;

constexpr std::uint32_t kWanted = 0x221, kOther = 0x222;
constexpr const char* kGadget = "/sys/kernel/config/usb_gadget/imu/UDC";

std::uint32_t number_of(const std::vector<std::uint8_t>& wire, RigTime received) {
  const auto frame = can_frame_of(wire, received);
  std::uint32_t number = 0;
  if (frame) std::memcpy(&number, frame->data.data(), sizeof number);
  return number;
}

// Frames of the wanted id, every one, in order, with stamps of the kernel; and again after the interface was down.
void expect_frames(const std::string& from, const std::string& to, std::uint32_t count) {
  const HostClock clock;
  CanSocket can({.interface = to, .ids = {{kWanted, false}}}, clock);
  Kept kept;
  can.tend(clock.now());
  ASSERT_GE(can.fd(), 0) << can.trouble();
  const hil::CanSender sender(from);
  const RigTime begin = clock.now();
  for (std::uint32_t i = 0; i < count; ++i) {
    sender.send(kOther, i);
    sender.send(kWanted, i);
    if (i % 16 == 0) can.read(kept);
  }
  EXPECT_TRUE(drive({{&can, &kept}}, clock, [&] { return kept.stamps.size() >= count; })) << kept.stamps.size();
  ASSERT_EQ(kept.stamps.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(number_of(kept.contents[i], kept.stamps[i]), i);
  EXPECT_GE(kept.stamps.front(), begin - Duration::from_seconds(0.01));
  EXPECT_LE(can.counts().no_stamp, 2U) << "the first frames after stamps are asked for may have none";

  hil::shell("/sbin/ip link set " + to + " down");
  EXPECT_TRUE(drive({{&can, &kept}}, clock, [&] { return can.counts().departures == 1; })) << can.trouble();
  hil::shell("/sbin/ip link set " + to + " up");
  EXPECT_TRUE(drive({{&can, &kept}}, clock, [&] { return can.fd() >= 0; })) << can.trouble();
  EXPECT_TRUE(drive({{&can, &kept}}, clock, [&] {
    sender.send(kWanted, count);
    return kept.stamps.size() > count;
  }));
}

TEST(HilCan, VirtualBusLosesNothing) { expect_frames("vcan0", "vcan0", 2000); }
TEST(HilCan, Sja1000PairAt500kBitLosesNothing) { expect_frames("can0", "can1", 300); }

// Line 5 is driven from outside: 0.1 s high of every 0.5 s.
TEST(HilGpio, EdgesOfALineThatIsDrivenFromOutside) {
  const HostClock clock;
  LibgpiodLine line;
  GpioEdges edges({.chip = "gpiochip0", .line = 5}, clock, line);
  Kept kept;
  ASSERT_TRUE(drive({{&edges, &kept}}, clock, [&] { return kept.stamps.size() >= 8; })) << edges.trouble();
  for (std::size_t i = 1; i < kept.stamps.size(); ++i) {
    EXPECT_LT(kept.stamps[i - 1], kept.stamps[i]);
    EXPECT_NE(kept.contents[i - 1][0], kept.contents[i][0]) << "rising and falling in turn";
  }
  EXPECT_LE(kept.stamps.back(), clock.now());
}

// Line 6 is the pulse source's; as line 5.
TEST(HilPps, PulsesOfTheKernelsOwnClient) {
  const HostClock clock;
  PpsSource source("/dev/pps0", PpsSource::Edge::assert, clock);
  source.tend(clock.now());
  ASSERT_TRUE(source.there()) << source.trouble();
  std::vector<PpsPulse> pulses;
  for (int i = 0; i < 60 && pulses.size() < 4; ++i) {
    if (const auto pulse = source.fetch(Duration::from_seconds(0.5))) pulses.push_back(*pulse);
  }
  ASSERT_EQ(pulses.size(), 4U) << source.trouble();
  for (std::size_t i = 1; i < pulses.size(); ++i) {
    EXPECT_EQ(pulses[i].sequence, pulses[i - 1].sequence + 1);
    EXPECT_GT((pulses[i].edge - pulses[i - 1].edge).seconds(), 0.2);
  }
  EXPECT_EQ(source.counts().missed, 0U);
}

// The host sends 200 of a VectorNav's frames by a USB serial adapter, over and over.
TEST(HilSerial, AnImuByAUsbAdapter) {
  class Parse final : public ChunkSink {
   public:
    void take(const Chunk& chunk) override {
      for (auto rest = chunk.bytes; !rest.empty();) {
        rest = rest.subspan(parser.feed(rest, chunk.received));
        for (ImuSample sample; parser.next(sample);) ++samples;
      }
    }
    VectorNavParser parser{115'200};
    std::uint64_t samples = 0;
  } parse;
  const HostClock clock;
  SerialPort port({.path = "/dev/ttyUSB0", .baud_rate = 115'200}, clock);
  EXPECT_TRUE(drive({{&port, &parse}}, clock, [&] { return parse.samples >= 200; })) << port.trouble();
  EXPECT_EQ(parse.parser.counts().bad_crc, 0U);
}

TEST(HilCamera, FramesInOrderWithPresentStamps) {
  const HostClock clock;
  V4l2Camera wrong({.path = "/dev/video0", .fourcc = V4L2_PIX_FMT_YUYV, .width = 641, .height = 361}, 0, clock);
  wrong.tend(clock.now());
  EXPECT_NE(wrong.trouble().find("wanted YUYV of 641 x 361"), std::string::npos) << wrong.trouble();
  V4l2Camera camera({.path = "/dev/video0",
                     .fourcc = V4L2_PIX_FMT_YUYV,
                     .width = 640,
                     .height = 360,
                     .rate_hz = 30,
                     .controls = {{"brightness", 100}}},
                    0, clock);
  Kept kept;
  ASSERT_TRUE(drive({{&camera, &kept}}, clock, [&] { return kept.stamps.size() >= 10; })) << camera.trouble();
  for (std::size_t i = 1; i < kept.stamps.size(); ++i) EXPECT_LT(kept.stamps[i - 1], kept.stamps[i]);
  EXPECT_EQ(kept.contents[0].size(), 640U * 360U * 2U);
  EXPECT_EQ(camera.camera_counts().other_clock, 0U);
}

// A gadget that sends without being asked; pulled out and put in again.
TEST(HilUsbBulk, TransfersAndReEnumeration) {
  const HostClock clock;
  UsbBulk device(*parse_usb_device("usb:0525:a4a0:42"), clock, std::make_unique<LibusbBulk>());
  Kept kept;
  ASSERT_TRUE(drive({{&device, &kept}}, clock, [&] { return kept.bytes >= 65536; })) << device.trouble();
  hil::shell(std::string("echo > ") + kGadget);
  EXPECT_TRUE(drive({{&device, &kept}}, clock, [&] { return device.fd() < 0; }));
  EXPECT_EQ(device.counts().departures, 1U);
  hil::shell(std::string("ls /sys/class/udc | head -1 > ") + kGadget);
  const std::size_t before = kept.bytes;
  EXPECT_TRUE(drive({{&device, &kept}}, clock, [&] { return kept.bytes > before; })) << device.trouble();
  EXPECT_EQ(device.counts().openings, 2U);
}

// One loop, as the board's I/O thread is: everything at once for some seconds, nothing lost.
TEST(HilAll, EveryDeviceAtOnce) {
  const HostClock clock;
  CanSocket virtual_can({.interface = "vcan0", .ids = {{kWanted, false}}}, clock);
  CanSocket real_can({.interface = "can1", .ids = {{kWanted, false}}}, clock);
  LibgpiodLine line;
  GpioEdges edges({.chip = "gpiochip0", .line = 5}, clock, line);
  SerialPort port({.path = "/dev/ttyUSB0", .baud_rate = 115'200}, clock);
  V4l2Camera camera({.path = "/dev/video0", .fourcc = V4L2_PIX_FMT_YUYV, .width = 320, .height = 180, .rate_hz = 10}, 0,
                    clock);
  UsbBulk usb(*parse_usb_device("usb:0525:a4a0"), clock, std::make_unique<LibusbBulk>());
  PpsSource source("/dev/pps0", PpsSource::Edge::assert, clock);
  source.tend(clock.now());
  Kept of_virtual, of_real, of_edges, of_port, of_camera, of_usb;
  const std::vector<hil::Driven> devices{{&virtual_can, &of_virtual}, {&real_can, &of_real}, {&edges, &of_edges},
                                         {&port, &of_port},           {&camera, &of_camera}, {&usb, &of_usb}};
  for (const hil::Driven& each : devices) each.device->tend(clock.now());
  const hil::CanSender virtual_sender("vcan0"), real_sender("can0");
  std::uint32_t sent = 0;
  std::size_t pulses = 0;
  const Duration pause = Duration::from_seconds(0.002);
  RigTime due = clock.now();
  const RigTime end = clock.now() + Duration::from_seconds(3);
  (void)drive(devices, clock, [&] {
    pulses += source.fetch(Duration::from_ns(0)) ? 1U : 0U;
    if (clock.now() > end) return sent == of_virtual.stamps.size() && sent == of_real.stamps.size();
    if (clock.now() < due) return false;
    due = clock.now() + pause;
    virtual_sender.send(kWanted, sent);
    real_sender.send(kWanted, sent++);
    return false;
  });
  EXPECT_EQ(of_virtual.stamps.size(), sent);
  EXPECT_EQ(of_real.stamps.size(), sent);
  EXPECT_GT(sent, 20U);
  EXPECT_GE(of_edges.stamps.size(), 6U);
  EXPECT_GE(pulses, 4U);
  EXPECT_GT(of_port.bytes, 1000U);
  EXPECT_GT(of_camera.stamps.size(), 5U);
  EXPECT_GT(of_usb.bytes, 65536U);
  for (const hil::Driven& each : devices) EXPECT_EQ(each.device->counts().departures, 0U) << each.device->name();
}

}  // namespace
}  // namespace lxd::kernel_devices_test
