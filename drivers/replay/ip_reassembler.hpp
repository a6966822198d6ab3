// SPDX-License-Identifier: Apache-2.0
// IPv4 fragments to UDP datagrams (RFC 791, RFC 768), within a bounded, fixed memory: a LiDAR datagram is larger than
// an Ethernet frame, so it nearly always comes in pieces, and sometimes a piece is lost.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lxd {

struct UdpDatagram {
  std::uint32_t source_address = 0;
  std::uint16_t source_port = 0, destination_port = 0;
  std::span<const std::uint8_t> payload;  // valid until the next packet
};

class IpReassembler {
 public:
  struct Counts {
    std::uint64_t malformed = 0;   // headers or lengths that contradict each other
    std::uint64_t incomplete = 0;  // datagrams given up for lack of a fragment
  };

  IpReassembler();

  // ipv4: one packet from its IP header on. None: not UDP, not complete yet, or refused.
  std::optional<UdpDatagram> add(std::span<const std::uint8_t> ipv4);
  // Counts what is still incomplete as lost.
  void finish();
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  static constexpr std::size_t kSlots = 16;        // datagrams under way at once
  static constexpr std::size_t kMaxBytes = 65536;  // of an IP payload
  static constexpr std::size_t kUnitBytes = 8;     // fragments come in multiples of this

  struct Key {
    std::uint64_t addresses = 0;  // source, then destination
    std::uint32_t id_and_protocol = 0;
    bool operator==(const Key&) const = default;
    [[nodiscard]] std::uint32_t source_address() const { return static_cast<std::uint32_t>(addresses >> 32U); }
  };
  struct Fragment {
    Key key;
    std::size_t offset = 0;
    bool last = false;
    std::span<const std::uint8_t> payload;
  };
  struct Slot {
    bool used = false;
    Key key;
    std::uint64_t started = 0;               // order of the first fragments
    std::optional<std::size_t> total_bytes;  // known with the last fragment
    std::size_t farthest_bytes = 0;          // end of the farthest fragment so far
    std::bitset<kMaxBytes / kUnitBytes> received;
    std::vector<std::uint8_t> bytes;
  };

  std::optional<Fragment> parse(std::span<const std::uint8_t> ipv4);
  std::optional<UdpDatagram> parse_udp(const Key& key, std::span<const std::uint8_t> payload);
  std::optional<UdpDatagram> add_fragment(const Fragment& fragment);
  Slot& slot_of(const Key& key);
  static bool complete(const Slot& slot);
  std::nullopt_t refuse();

  std::array<Slot, kSlots> slots_;
  std::uint64_t starts_ = 0;
  Counts counts_;
};

}  // namespace lxd
