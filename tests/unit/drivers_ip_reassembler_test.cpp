// SPDX-License-Identifier: Apache-2.0
// IPv4 fragments: any order, losses, lies, and bounded memory.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "drivers/replay/ip_reassembler.hpp"

namespace lxd::drivers_ip_reassembler_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put16(Bytes& bytes, std::size_t at, std::size_t value) {
  bytes[at] = static_cast<std::uint8_t>(value >> 8U);
  bytes[at + 1] = static_cast<std::uint8_t>(value);
}

// An IP packet with part of a UDP datagram.
Bytes packet(std::uint16_t id, std::size_t offset, bool more, const Bytes& payload) {
  Bytes ip(20 + payload.size());
  ip[0] = 0x45;
  put16(ip, 2, ip.size());
  put16(ip, 4, id);
  put16(ip, 6, offset / 8 | (more ? 0x2000U : 0U));
  ip[9] = 17;
  std::copy(payload.begin(), payload.end(), ip.begin() + 20);
  return ip;
}

Bytes udp(std::size_t payload_bytes) {
  Bytes bytes(8 + payload_bytes);
  put16(bytes, 0, 1111);
  put16(bytes, 2, 7502);
  put16(bytes, 4, bytes.size());
  for (std::size_t i = 0; i < payload_bytes; ++i) bytes[8 + i] = static_cast<std::uint8_t>(i * 7);
  return bytes;
}

std::vector<Bytes> fragments(std::uint16_t id, const Bytes& datagram, std::size_t piece) {
  std::vector<Bytes> pieces;
  for (std::size_t at = 0; at < datagram.size(); at += piece) {
    const std::size_t end = std::min(at + piece, datagram.size());
    pieces.push_back(packet(id, at, end < datagram.size(),
                            Bytes(datagram.begin() + static_cast<std::ptrdiff_t>(at),
                                  datagram.begin() + static_cast<std::ptrdiff_t>(end))));
  }
  return pieces;
}

TEST(IpReassembler, WholeDatagramPassesThrough) {
  IpReassembler reassembler;
  Bytes ip = packet(1, 0, false, udp(48));
  put16(ip, 12, 0xC0A8);
  put16(ip, 14, 0x0107);
  const auto datagram = reassembler.add(ip);
  ASSERT_TRUE(datagram.has_value());
  EXPECT_EQ(datagram->source_address, 0xC0A80107U);  // 192.168.1.7
  EXPECT_EQ(datagram->source_port, 1111);
  EXPECT_EQ(datagram->destination_port, 7502);
  EXPECT_EQ(datagram->payload.size(), 48U);
}

TEST(IpReassembler, FragmentsInAnyOrderGiveTheDatagram) {
  IpReassembler reassembler;
  const Bytes whole = udp(3001);
  const std::vector<Bytes> pieces = fragments(1, whole, 1000);
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  ASSERT_EQ(pieces.size(), order.size());
  std::uint16_t id = 0;
  do {
    std::optional<UdpDatagram> datagram;
    for (const std::size_t i : order) {
      Bytes piece = pieces[i];
      put16(piece, 4, id);
      put16(piece, 14, 9);
      EXPECT_FALSE(datagram.has_value());
      datagram = reassembler.add(piece);
    }
    ASSERT_TRUE(datagram.has_value());
    EXPECT_EQ(datagram->source_address, 9U);
    EXPECT_TRUE(std::equal(datagram->payload.begin(), datagram->payload.end(), whole.begin() + 8, whole.end()));
    ++id;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(id, 24);
  EXPECT_EQ(reassembler.counts().malformed, 0U);
}

TEST(IpReassembler, LostFragmentLosesItsDatagramOnly) {
  IpReassembler reassembler;
  const std::vector<Bytes> first = fragments(1, udp(3000), 1000), second = fragments(2, udp(3000), 1000);
  for (const std::size_t i : {0U, 1U, 3U}) EXPECT_FALSE(reassembler.add(first[i]).has_value());
  for (const std::size_t i : {0U, 1U, 2U}) EXPECT_FALSE(reassembler.add(second[i]).has_value());
  EXPECT_TRUE(reassembler.add(second[3]).has_value());
  reassembler.finish();
  EXPECT_EQ(reassembler.counts().incomplete, 1U);
}

TEST(IpReassembler, OldestGivesWayWhenAllSlotsAreTaken) {
  IpReassembler reassembler;
  for (std::uint16_t id = 0; id < 100; ++id) reassembler.add(fragments(id, udp(3000), 1000)[0]);
  EXPECT_EQ(reassembler.counts().incomplete, 84U);
  const std::vector<Bytes> newest = fragments(99, udp(3000), 1000);
  EXPECT_FALSE(reassembler.add(newest[1]).has_value());
  EXPECT_FALSE(reassembler.add(newest[2]).has_value());
  EXPECT_TRUE(reassembler.add(newest[3]).has_value());
}

TEST(IpReassembler, ContradictionsAreRefused) {
  IpReassembler reassembler;
  EXPECT_FALSE(reassembler.add(packet(1, 8000, true, Bytes(8))).has_value());
  EXPECT_FALSE(reassembler.add(packet(1, 800, false, Bytes(8))).has_value());  // ends before what is there already
  EXPECT_FALSE(reassembler.add(packet(2, 65528, true, Bytes(16))).has_value());
  EXPECT_FALSE(reassembler.add(packet(3, 0, true, Bytes(7))).has_value());
  EXPECT_FALSE(reassembler.add(packet(4, 0, false, Bytes(7))).has_value());  // shorter than a UDP header
  Bytes long_udp = udp(10);
  put16(long_udp, 4, 19);
  EXPECT_FALSE(reassembler.add(packet(5, 0, false, long_udp)).has_value());
  EXPECT_EQ(reassembler.counts().malformed, 5U);
}

TEST(IpReassembler, TruncatedAtAnyLengthIsRefused) {
  IpReassembler reassembler;
  const Bytes ip = packet(1, 0, false, udp(20));
  for (std::size_t bytes = 0; bytes < ip.size(); ++bytes) {
    EXPECT_FALSE(reassembler.add(Bytes(ip.begin(), ip.begin() + static_cast<std::ptrdiff_t>(bytes))).has_value());
  }
  EXPECT_EQ(reassembler.counts().malformed, ip.size());
}

}  // namespace
}  // namespace lxd::drivers_ip_reassembler_test
