// SPDX-License-Identifier: Apache-2.0
// Datagram in, columns out: a pure function of bytes. Every length is checked before a byte is read, every refusal is
// counted by cause. Allocates nothing; the columns point into the datagram.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/ouster/packet_format.hpp"

namespace lxd {

struct OusterColumn {
  std::uint64_t timestamp_ns = 0;          // sensor time
  std::uint16_t measurement_id = 0;        // 0 .. columns_per_frame - 1
  const std::uint8_t* channels = nullptr;  // pixels_per_column blocks
};

// The sound columns of a packet.
struct OusterPacket {
  std::uint32_t frame_id = 0;
  std::uint16_t first_measurement_id = 0;  // as the packet says it, sound or not
  std::uint16_t count = 0;
  std::array<OusterColumn, kOusterMaxColumnsPerPacket> storage{};

  [[nodiscard]] std::span<const OusterColumn> columns() const { return std::span(storage).first(count); }
};

// Whole packets refused, then single columns of sound packets.
struct OusterParserCounts {
  std::uint64_t packets = 0;  // accepted
  std::uint64_t bad_size = 0, bad_packet_type = 0, bad_init_id = 0, bad_serial = 0, bad_crc = 0;
  std::uint64_t restarts = 0;             // of the sensor: a new init id that stayed
  std::uint64_t invalid_column = 0;       // the sensor says so (status bit)
  std::uint64_t bad_measurement_id = 0;   // beyond the frame
  std::uint64_t bad_column_frame_id = 0;  // another frame than the packet's first column
};

class OusterPacketParser {
 public:
  static constexpr int kRestartPackets = 16;

  // init_id, serial: of the metadata; none: not checked (firmware before 2.2 sends neither). A sensor of that serial
  // number whose packets have another init id kRestartPackets times in a row has restarted, and is followed.
  // Precondition: format.columns_per_packet is 1 .. kOusterMaxColumnsPerPacket.
  OusterPacketParser(const OusterPacketFormat& format, std::uint16_t columns_per_frame,
                     std::optional<std::uint32_t> init_id, std::optional<std::uint64_t> serial = std::nullopt)
      : format_(format), columns_per_frame_(columns_per_frame), init_id_(init_id), serial_(serial) {}

  // False: refused and counted; `packet` is then without meaning.
  bool parse(std::span<const std::uint8_t> datagram, OusterPacket& packet);

  [[nodiscard]] const OusterParserCounts& counts() const { return counts_; }

 private:
  bool accept_header(std::span<const std::uint8_t> datagram);
  bool accept_sensor(const std::uint8_t* header);
  bool accept_init_id(const std::uint8_t* header);
  [[nodiscard]] bool crc_holds(std::span<const std::uint8_t> datagram) const;
  [[nodiscard]] std::uint32_t frame_id(const std::uint8_t* datagram) const;
  void take_column(const std::uint8_t* column, OusterPacket& packet);

  OusterPacketFormat format_;
  std::uint16_t columns_per_frame_;
  std::optional<std::uint32_t> init_id_;
  std::optional<std::uint64_t> serial_;
  std::uint64_t other_init_id_ = 0;  // that the last packets had, and how many of them
  int other_init_ids_ = 0;
  OusterParserCounts counts_;
};

}  // namespace lxd
