// SPDX-License-Identifier: Apache-2.0
// SDK1 datagram in, points or an inertial sample out, as LivoxPacketParser does for SDK2: the packets go into the same
// sweep builder. Every length is checked before a byte is read, every refusal is counted by cause. Allocates nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/livox/packet_parser.hpp"
#include "drivers/livox/sdk1_format.hpp"

namespace lxd {

class LivoxSdk1Parser {
 public:
  // shot_ns: kLivoxMidShot_ns or kLivoxHorizonShot_ns. Precondition: shot_ns > 0.
  explicit LivoxSdk1Parser(std::uint32_t shot_ns) : shot_ns_(shot_ns) {}

  // False: refused and counted; `packet` is then without meaning.
  bool parse(std::span<const std::uint8_t> datagram, LivoxPacket& packet);

  [[nodiscard]] const LivoxParserCounts& counts() const { return counts_; }

 private:
  bool accept(std::span<const std::uint8_t> datagram);

  std::uint32_t shot_ns_;
  LivoxParserCounts counts_;
};

// ns since 1970 with GPS, of the sensor's own count otherwise; none: no such time.
std::optional<std::uint64_t> livox_sdk1_time_ns(std::uint64_t time_type, const std::uint8_t* stamp);

}  // namespace lxd
