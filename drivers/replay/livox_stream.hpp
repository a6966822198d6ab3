// SPDX-License-Identifier: Apache-2.0
// Which Livox sensor a capture is of, and how its packets are read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <variant>

#include "drivers/livox/sdk1_parser.hpp"
#include "drivers/replay/ip_reassembler.hpp"

namespace lxd {

struct LivoxSender {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  bool operator==(const LivoxSender&) const = default;
};
LivoxSender sender_of(const UdpDatagram& datagram);

// The parser of SDK2's or of SDK1's packets.
struct LivoxParser {
  std::variant<LivoxPacketParser, LivoxSdk1Parser> parser;

  bool parse(std::span<const std::uint8_t> datagram, LivoxPacket& packet) {
    return std::visit([&](auto& p) { return p.parse(datagram, packet); }, parser);
  }
  [[nodiscard]] const LivoxParserCounts& counts() const {
    return std::visit([](const auto& p) -> const LivoxParserCounts& { return p.counts(); }, parser);
  }
};

struct LivoxStream {
  LivoxSender sender;
  LivoxParser parser;
};

// The first sensor that sends point packets within the capture's first 1000 datagrams. SDK2 packets are told by their
// header; SDK1 ones, whose header says little, by eight in a row from one sender whose stamps go on from each to the
// next by a sound step, which also tells the shots' rate. None: there is no such sensor, or no readable capture.
std::optional<LivoxStream> find_livox_stream(const std::filesystem::path& pcap);

}  // namespace lxd
