// SPDX-License-Identifier: Apache-2.0
// A UDP port: who is heard, who is not, and what is counted.
#include "drivers/device/udp_socket.hpp"
#include "tests/support/emulated.hpp"
#include "tests/support/loopback.hpp"

namespace lxd::test::drivers_udp_socket_test {
namespace {

class UdpPort : public testing::Test {
 protected:
  std::unique_ptr<UdpSocket> opened(const UdpConfig& config) {
    auto socket = UdpSocket::open(config, clock_);
    EXPECT_TRUE(socket.ok());
    return std::move(*socket);
  }

  // Reads until so many datagrams have been dealt with, heard or not.
  void read(UdpSocket& socket, std::uint64_t datagrams) {
    const auto& counts = socket.counts();
    while (counts.chunks + counts.foreign + counts.cut < datagrams && readable(socket)) socket.read(heard_);
  }

  HostClock clock_;
  KeepChunks heard_;
};

// Given a sensor that sends, then its datagrams come whole and in order, with its address and the kernel's stamp.
TEST_F(UdpPort, HandsOverDatagramsWithSenderAndStamp) {
  if (emulated()) GTEST_SKIP() << kNoKernelStamps;
  const auto socket = opened({.sources = {{kLoopback, 3}}});
  const UdpSender sensor;
  const RigTime before = clock_.now();
  for (const char* text : {"one", "", "three"}) sensor.send(socket->port(), text);
  read(*socket, 3);
  ASSERT_EQ(heard_.chunks.size(), 3U);
  EXPECT_EQ(heard_.chunks[0].text, "one");
  EXPECT_EQ(heard_.chunks[1].text, "");
  EXPECT_EQ(heard_.chunks[2].text, "three");
  EXPECT_EQ(heard_.chunks[0].channel, 3);
  EXPECT_EQ(heard_.chunks[0].origin.source_address, kLoopback);
  EXPECT_EQ(heard_.chunks[0].origin.destination_address, kLoopback);
  EXPECT_NE(heard_.chunks[0].origin.source_port, 0);
  EXPECT_EQ(heard_.chunks[0].origin.destination_port, socket->port());
  EXPECT_GE(heard_.chunks[0].received, before - Duration::from_ns(1'000'000));
  EXPECT_LE(heard_.chunks[2].received, clock_.now());
  EXPECT_EQ(socket->counts().no_stamp, 0U);
  EXPECT_EQ(socket->counts().bytes, 8U);
}

// Given two sensors that send to one port, then their addresses tell them apart, and a third sender is not heard.
TEST_F(UdpPort, TellsTwoSensorsApartAndCountsForeigners) {
  const auto socket = opened({.sources = {{kLoopback, 0}, {kLoopback + 1, 1}}});
  const UdpSender first(kLoopback), second(kLoopback + 1), foreigner(kLoopback + 2);
  for (int i = 0; i < 5; ++i) {
    first.send(socket->port(), "first");
    second.send(socket->port(), "second");
    foreigner.send(socket->port(), "foreign");
  }
  read(*socket, 15);
  ASSERT_EQ(heard_.chunks.size(), 10U);
  for (const auto& chunk : heard_.chunks) EXPECT_EQ(chunk.text, chunk.channel == 0 ? "first" : "second");
  EXPECT_EQ(socket->counts().foreign, 5U);
}

TEST_F(UdpPort, GivesAnyOtherSenderTheChannelOfAddressZero) {
  const auto socket = opened({.sources = {{0, 0}, {kLoopback + 1, 1}}});
  UdpSender(kLoopback + 5).send(socket->port(), "any");
  UdpSender(kLoopback + 1).send(socket->port(), "named");
  read(*socket, 2);
  ASSERT_EQ(heard_.chunks.size(), 2U);
  EXPECT_EQ(heard_.chunks[0].channel, 0);
  EXPECT_EQ(heard_.chunks[1].channel, 1);
}

// Given a datagram longer than any that is expected, then it is counted and left out; one that just fits is not.
TEST_F(UdpPort, LeavesOutDatagramsThatDoNotFit) {
  const auto socket = opened({.datagram_max = 100, .sources = {{0, 0}}});
  const UdpSender sensor;
  sensor.send(socket->port(), std::string(101, 'x'));
  sensor.send(socket->port(), std::string(100, 'y'));
  read(*socket, 2);
  ASSERT_EQ(heard_.chunks.size(), 1U);
  EXPECT_EQ(heard_.chunks[0].text.front(), 'y');
  EXPECT_EQ(socket->counts().cut, 1U);
}

// Given more than the kernel has room for while nobody reads, then all that was sent is heard or counted as lost.
TEST_F(UdpPort, CountsWhatTheKernelLost) {
  if (emulated()) GTEST_SKIP() << kNoKernelStamps << ", nor counts";
  const auto socket = opened({.receive_buffer_bytes = 4096, .sources = {{0, 0}}});
  const UdpSender sensor;
  constexpr std::uint64_t kSent = 200;
  for (std::uint64_t i = 0; i < kSent; ++i) sensor.send(socket->port(), std::string(1000, 'x'));
  while (readable(*socket, std::chrono::milliseconds(0))) socket->read(heard_);
  EXPECT_LT(heard_.chunks.size(), kSent);
  // The count comes with the next datagram that has room.
  sensor.send(socket->port(), "last");
  read(*socket, heard_.chunks.size() + 1);
  EXPECT_EQ(heard_.chunks.size() + socket->counts().kernel_overflow, kSent + 1);
}

// Given many datagrams at once, then one read takes a bounded number, and the rest is there for the next.
TEST_F(UdpPort, TakesABoundedNumberAtOnce) {
  const auto socket = opened({.sources = {{0, 0}}});
  const UdpSender sensor;
  for (int i = 0; i < 3 * Device::kChunksPerRead; ++i) sensor.send(socket->port(), "x");
  ASSERT_TRUE(readable(*socket));
  socket->read(heard_);
  EXPECT_EQ(heard_.chunks.size(), std::size_t{Device::kChunksPerRead});
  read(*socket, 3 * Device::kChunksPerRead);
  EXPECT_EQ(heard_.chunks.size(), std::size_t{3 * Device::kChunksPerRead});
}

TEST_F(UdpPort, AsksForABufferAndSaysWhatItGot) {
  EXPECT_GE(opened({.receive_buffer_bytes = 100'000, .sources = {{0, 0}}})->receive_buffer_bytes(), 100'000U);
}

TEST_F(UdpPort, IsRefusedWhereAnotherListens) {
  const auto socket = opened({.sources = {{0, 0}}});
  const auto second = UdpSocket::open({.port = socket->port(), .sources = {{0, 0}}}, clock_);
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find("cannot be listened to"), std::string::npos) << second.error().message;
}

TEST_F(UdpPort, IsRefusedForAGroupThatIsNone) {
  const auto socket = UdpSocket::open({.multicast_group = kLoopback, .sources = {{0, 0}}}, clock_);
  ASSERT_FALSE(socket.ok());
  EXPECT_NE(socket.error().message.find("multicast"), std::string::npos);
}

}  // namespace
}  // namespace lxd::test::drivers_udp_socket_test
