// SPDX-License-Identifier: Apache-2.0
// A UDP datagram as the Ethernet frames that a host receives: IPv4 fragments of at most 1500 bytes (RFC 768, 791,
// 1071), lengths and check sums right.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lxd {

struct UdpEnd {
  std::array<std::uint8_t, 4> address{};
  std::uint16_t port = 0;
};

struct UdpRoute {
  UdpEnd source, destination;
};

class UdpFramer {
 public:
  // Precondition: at most 65507 bytes. The frames are valid until the next call. Each call takes the next IP
  // identification, so that the fragments of two datagrams never mix.
  std::span<const std::vector<std::uint8_t>> frames(const UdpRoute& route, std::span<const std::uint8_t> payload);

 private:
  void frame_fragment(const UdpRoute& route, std::size_t offset, std::vector<std::uint8_t>& frame) const;

  std::uint16_t identification_ = 0;
  std::vector<std::uint8_t> udp_;  // header and payload
  std::vector<std::vector<std::uint8_t>> frames_;
};

}  // namespace lxd
