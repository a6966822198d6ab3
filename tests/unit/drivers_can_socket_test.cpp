// SPDX-License-Identifier: Apache-2.0
// CAN frames from the kernel: their form, what error frames tell, and an interface that is not there. A pair of local
// sockets stands in for the interface; on a machine with vcan the real one is tried too.
#include <cstdlib>
#include <cstring>

#include <linux/can.h>
#include <linux/can/error.h>
#include <net/if.h>

#include "drivers/device/can_socket.hpp"
#include "tests/support/emulated.hpp"
#include "tests/support/loopback.hpp"

namespace lxd::test::drivers_can_socket_test {
namespace {

constexpr const char* kVirtualBus = "vcan0";

can_frame frame_of(canid_t id, const std::string& data) {
  can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = static_cast<__u8>(data.size());
  std::memcpy(frame.data, data.data(), data.size());
  return frame;
}

std::span<const std::uint8_t> wire_of(const can_frame& frame) {
  return {reinterpret_cast<const std::uint8_t*>(&frame), sizeof(frame)};
}

TEST(CanWire, KeepsIdKindLengthAndData) {
  const RigTime received = RigTime::from_ns(7);
  const auto standard = can_frame_of(wire_of(frame_of(0x123, "abc")), received);
  ASSERT_TRUE(standard);
  EXPECT_EQ(standard->id, 0x123U);
  EXPECT_FALSE(standard->extended);
  EXPECT_EQ(standard->kind, CanKind::data);
  EXPECT_EQ(standard->length, 3);
  EXPECT_EQ(standard->data, (CanData{'a', 'b', 'c'}));
  EXPECT_EQ(standard->received, received);

  const auto extended = can_frame_of(wire_of(frame_of(0x18FF1234 | CAN_EFF_FLAG, "")), received);
  EXPECT_TRUE(extended->extended);
  EXPECT_EQ(extended->id, 0x18FF1234U);
  EXPECT_EQ(can_frame_of(wire_of(frame_of(0x123 | CAN_RTR_FLAG, "")), received)->kind, CanKind::remote);
  const auto error = can_frame_of(wire_of(frame_of(CAN_ERR_FLAG | CAN_ERR_BUSOFF, "01234567")), received);
  EXPECT_EQ(error->kind, CanKind::error);
  EXPECT_EQ(error->id, kCanErrorBusOff);
}

TEST(CanWire, RefusesWhatIsNoClassicFrame) {
  can_frame frame = frame_of(0x123, "abc");
  for (std::size_t size = 0; size < sizeof(frame); ++size)
    EXPECT_FALSE(can_frame_of(wire_of(frame).first(size), RigTime())) << size;
  frame.can_dlc = CAN_MAX_DLEN + 1;
  EXPECT_FALSE(can_frame_of(wire_of(frame), RigTime()));
}

class CanBus : public testing::Test {
 protected:
  CanBus() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends.data()), 0);
    far_end_ = FileDescriptor(ends[1]);
    bus_.emplace(CanConfig{"can7", {}, 5}, clock_, FileDescriptor(ends[0]));
  }
  void send(const can_frame& frame) { EXPECT_EQ(::send(far_end_.get(), &frame, sizeof(frame), 0), sizeof(frame)); }
  void send_error(canid_t classes, std::uint8_t controller = 0) {
    send(frame_of(CAN_ERR_FLAG | classes, {'\0', static_cast<char>(controller), '\0', '\0', '\0', '\0', '\0', '\0'}));
  }

  HostClock clock_;
  FileDescriptor far_end_;
  std::optional<CanSocket> bus_;
  KeepChunks heard_;
};

TEST_F(CanBus, HandsOverFramesWithTheKernelsStamp) {
  if (emulated()) GTEST_SKIP() << kNoKernelStamps;
  const RigTime before = clock_.now();
  for (canid_t id = 0x100; id < 0x110; ++id) send(frame_of(id, "data"));
  bus_->read(heard_);
  ASSERT_EQ(heard_.chunks.size(), 16U);
  for (canid_t i = 0; i < 16; ++i) {
    const auto frame = can_frame_of(bytes_of(heard_.chunks[i].text), heard_.chunks[i].received);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->id, 0x100 + i);
    EXPECT_GE(frame->received, before - Duration::from_ns(1'000'000));
  }
  EXPECT_EQ(heard_.chunks[0].channel, 5);
  EXPECT_EQ(bus_->counts().no_stamp, 0U);
}

// Given a controller that gets into trouble, leaves the bus and comes back, then each is counted, and it is known
// whether it is on the bus.
TEST_F(CanBus, FollowsTheControllerOffTheBusAndBack) {
  send_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  send_error(CAN_ERR_BUSOFF);
  bus_->read(heard_);
  EXPECT_TRUE(bus_->bus_off());
  EXPECT_EQ(bus_->counts().error_passive, 1U);
  EXPECT_EQ(bus_->counts().bus_off, 1U);
  EXPECT_EQ(bus_->counts().bus_back, 0U);

  send_error(CAN_ERR_RESTARTED);
  send(frame_of(0x100, "data"));
  bus_->read(heard_);
  EXPECT_FALSE(bus_->bus_off());
  EXPECT_EQ(bus_->counts().bus_back, 1U);
  EXPECT_EQ(bus_->counts().error_frames, 3U);
  EXPECT_EQ(heard_.chunks.size(), 4U);  // error frames are handed over too: a recording has them
}

TEST_F(CanBus, IsBackWithTheFirstFrameWhereNoRestartWasTold) {
  send_error(CAN_ERR_BUSOFF);
  send(frame_of(0x100, "data"));
  bus_->read(heard_);
  EXPECT_FALSE(bus_->bus_off());
  EXPECT_EQ(bus_->counts().bus_back, 1U);
}

TEST_F(CanBus, LeavesOutWhatIsNoFrame) {
  EXPECT_EQ(::send(far_end_.get(), "short", 5, 0), 5);
  send(frame_of(0x100, "data"));
  bus_->read(heard_);
  EXPECT_EQ(heard_.chunks.size(), 1U);
  EXPECT_EQ(bus_->counts().cut, 1U);
}

TEST(CanInterface, IsAwayWhereThereIsNone) {
  const HostClock clock;
  CanSocket bus({"no-such-bus", {}}, clock);
  bus.tend(clock.now());
  EXPECT_EQ(bus.fd(), -1);
  EXPECT_FALSE(bus.trouble().empty());
}

// Given a virtual bus (`ip link add vcan0 type vcan; ip link set vcan0 up`), then only the frames that are wanted come.
TEST(CanInterface, HearsOnlyTheIdsThatAreWanted) {
  if (::if_nametoindex(kVirtualBus) == 0) GTEST_SKIP() << "this machine has no interface " << kVirtualBus;
  const HostClock clock;
  CanSocket bus({kVirtualBus, {{0x221, false}, {0x18FF1234, true}}}, clock);
  bus.tend(clock.now());
  ASSERT_GE(bus.fd(), 0) << bus.trouble();
  const FileDescriptor sender(::socket(PF_CAN, SOCK_RAW, CAN_RAW));
  sockaddr_can end{};
  end.can_family = AF_CAN;
  end.can_ifindex = static_cast<int>(::if_nametoindex(kVirtualBus));
  ASSERT_EQ(::bind(sender.get(), reinterpret_cast<const sockaddr*>(&end), sizeof(end)), 0);
  for (const canid_t id : {0x220U, 0x221U, 0x18FF1234U | CAN_EFF_FLAG, 0x221U | CAN_EFF_FLAG}) {
    const can_frame frame = frame_of(id, "data");
    ASSERT_EQ(::write(sender.get(), &frame, sizeof(frame)), static_cast<ssize_t>(sizeof(frame)));
  }
  KeepChunks heard;
  while (heard.chunks.size() < 2 && readable(bus)) bus.read(heard);
  ASSERT_EQ(heard.chunks.size(), 2U);
  EXPECT_EQ(can_frame_of(bytes_of(heard.chunks[0].text), RigTime())->id, 0x221U);
  EXPECT_EQ(can_frame_of(bytes_of(heard.chunks[1].text), RigTime())->id, 0x18FF1234U);
}

}  // namespace
}  // namespace lxd::test::drivers_can_socket_test
