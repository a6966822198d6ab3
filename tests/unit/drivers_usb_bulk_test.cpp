// SPDX-License-Identifier: Apache-2.0
// A sensor by USB bulk transfers, on a made bus: read, pulled out, re-enumerated; and libusb's own word where it is
// not.
#include <gtest/gtest.h>

#include "drivers/device/libusb_bulk.hpp"
#include "drivers/device/usb_bulk.hpp"

namespace lxd::drivers_usb_bulk_test {
namespace {

struct Bus {
  bool present = true;
  std::vector<std::vector<std::uint8_t>> waiting;
  int open_devices = 0;
};

class MadeBus final : public UsbBulkApi {
 public:
  explicit MadeBus(Bus& bus) : bus_(bus) {}
  Status open(const UsbBulkConfig&) override {
    if (!bus_.present) return Error{"not there"};
    ++bus_.open_devices;
    return success();
  }
  [[nodiscard]] int fd() const override { return 1000; }
  Status read(const std::function<void(std::span<const std::uint8_t>)>& take) override {
    for (const auto& transfer : std::exchange(bus_.waiting, {})) take(transfer);
    return bus_.present ? success() : Status(Error{"the device is gone"});
  }
  void close() override { --bus_.open_devices; }

 private:
  Bus& bus_;
};

class Bytes final : public ChunkSink {
 public:
  void take(const Chunk& chunk) override {
    received.insert(received.end(), chunk.bytes.begin(), chunk.bytes.end());
    channel = chunk.channel;
  }
  std::vector<std::uint8_t> received;
  int channel = -1;
};

TEST(UsbBulk, DeliversTransfersAndIsFoundAgainAfterItWasPulledOut) {
  const HostClock clock;
  Bus bus;
  {
    UsbBulk device({.vendor = 0x199b, .product = 0x3065, .serial = "42", .channel = 5}, clock,
                   std::make_unique<MadeBus>(bus));
    EXPECT_EQ(device.name(), "usb 199b:3065 42");
    EXPECT_EQ(device.fd(), -1);
    device.tend(RigTime::from_ns(0));
    EXPECT_EQ(device.fd(), 1000);
    bus.waiting = {{1, 2}, {3}};
    Bytes bytes;
    device.read(bytes);
    EXPECT_EQ(bytes.received, (std::vector<std::uint8_t>{1, 2, 3}));
    EXPECT_EQ(bytes.channel, 5);

    bus.present = false;
    bus.waiting = {{4}};  // arrived before
    device.read(bytes);
    EXPECT_EQ(bytes.received.size(), 4U);
    EXPECT_EQ(device.trouble(), "usb 199b:3065 42: the device is gone");
    EXPECT_EQ(bus.open_devices, 0);
    device.tend(RigTime::from_ns(0) + Duration::from_seconds(1));
    EXPECT_EQ(device.fd(), -1);
    bus.present = true;
    device.tend(RigTime::from_ns(0) + Duration::from_seconds(9));
    EXPECT_TRUE(device.trouble().empty());
    EXPECT_EQ(device.counts().openings, 2U);
    EXPECT_EQ(device.counts().departures, 1U);
    EXPECT_EQ(bus.open_devices, 1);
  }
  EXPECT_EQ(bus.open_devices, 0) << "the device gives it back";
}

// Vendor 0xffff is nobody's.
TEST(UsbBulk, LibusbSaysThatADeviceIsNotThere) {
  LibusbBulk bus;
  const Status opened = bus.open({.vendor = 0xffff, .product = 0xfffe});
  ASSERT_FALSE(opened);
  EXPECT_FALSE(opened.error().message.empty());
  EXPECT_EQ(bus.fd(), -1);
  bus.close();
}

TEST(UsbBulk, ARigFileNamesItByVendorProductAndSerialNumber) {
  const auto any = parse_usb_device("usb:199b:3065");
  ASSERT_TRUE(any);
  EXPECT_EQ(any->vendor, 0x199b);
  EXPECT_EQ(any->product, 0x3065);
  EXPECT_TRUE(any->serial.empty());
  EXPECT_EQ(parse_usb_device("usb:0525:A4A0:6234.1")->serial, "6234.1");
  for (const char* wrong : {"", "usb:", "usb:199b", "usb:199b:", "usb:199b:30", "usb:199b:30g5", "usb:199b.3065",
                            "usb:199b:3065:", "usb:199b:30651", "USB:199b:3065", "/dev/ttyUSB0"})
    EXPECT_FALSE(parse_usb_device(wrong)) << wrong;
}

}  // namespace
}  // namespace lxd::drivers_usb_bulk_test
