// SPDX-License-Identifier: Apache-2.0
// See packet_parser.hpp.
#include "drivers/ouster/packet_parser.hpp"

#include "drivers/crc.hpp"
#include "drivers/refuse.hpp"

namespace lxd {
namespace {

// What firmware 2.2 and 2.3 leave in the footer in place of a check value (seen in captures of both).
constexpr std::uint64_t kNoCrcFirmware22 = 0;
constexpr std::uint64_t kNoCrcFirmware23 = 0xDEADBEEF0000C0DEULL;
constexpr std::uint64_t kColumnValid = 1;

}  // namespace

bool OusterPacketParser::parse(std::span<const std::uint8_t> datagram, OusterPacket& packet) {
  if (!accept_header(datagram)) return false;
  packet.frame_id = frame_id(datagram.data());
  packet.first_measurement_id =
      static_cast<std::uint16_t>(format_.framing().measurement_id.get(datagram.data() + format_.column_offset(0)));
  packet.count = 0;
  for (std::size_t c = 0; c < format_.columns_per_packet; ++c) {
    take_column(datagram.data() + format_.column_offset(c), packet);
  }
  ++counts_.packets;
  return true;
}

bool OusterPacketParser::accept_header(std::span<const std::uint8_t> datagram) {
  if (datagram.size() != format_.packet_bytes()) return refuse(counts_.bad_size);
  const OusterFraming& framing = format_.framing();
  if (framing.packet_type.present() && framing.packet_type.get(datagram.data()) != kOusterLidarPacket) {
    return refuse(counts_.bad_packet_type);
  }
  if (!crc_holds(datagram)) return refuse(counts_.bad_crc);
  return accept_sensor(datagram.data());
}

// Another sensor, or another run of the same. The serial number comes first: another sensor has another init id too.
bool OusterPacketParser::accept_sensor(const std::uint8_t* header) {
  const OusterFraming& framing = format_.framing();
  if (serial_ && framing.serial.present() && framing.serial.get(header) != *serial_) return refuse(counts_.bad_serial);
  if (!init_id_ || !framing.init_id.present()) return true;
  return accept_init_id(header);
}

// Without a serial number to go by it may as well be another sensor.
bool OusterPacketParser::accept_init_id(const std::uint8_t* header) {
  const OusterFraming& framing = format_.framing();
  const std::uint64_t found = framing.init_id.get(header);
  if (found == *init_id_) {
    other_init_ids_ = 0;
    return true;
  }
  other_init_ids_ = found == other_init_id_ ? other_init_ids_ + 1 : 1;
  other_init_id_ = found;
  const bool known_sensor = serial_ && framing.serial.present();
  if (!known_sensor || other_init_ids_ < kRestartPackets) return refuse(counts_.bad_init_id);
  init_id_ = static_cast<std::uint32_t>(found);
  other_init_ids_ = 0;
  ++counts_.restarts;
  return true;
}

bool OusterPacketParser::crc_holds(std::span<const std::uint8_t> datagram) const {
  const BitField& crc = format_.framing().crc;
  if (!crc.present()) return true;
  const std::uint64_t found = crc.get(datagram.data() + format_.footer_offset());
  if (found == kNoCrcFirmware22 || found == kNoCrcFirmware23) return true;
  return found == crc64(datagram.first(datagram.size() - sizeof found));
}

std::uint32_t OusterPacketParser::frame_id(const std::uint8_t* datagram) const {
  const OusterFraming& framing = format_.framing();
  const std::uint64_t id = framing.packet_frame_id.present()
                               ? framing.packet_frame_id.get(datagram)
                               : framing.column_frame_id.get(datagram + format_.column_offset(0));
  return static_cast<std::uint32_t>(id);
}

void OusterPacketParser::take_column(const std::uint8_t* column, OusterPacket& packet) {
  const OusterFraming& framing = format_.framing();
  const std::uint8_t* const footer = column + format_.column_bytes() - framing.column_footer_bytes;
  const std::uint64_t status = framing.header_status.get(column) | framing.footer_status.get(footer);
  const auto measurement_id = static_cast<std::uint16_t>(framing.measurement_id.get(column));
  if ((status & kColumnValid) == 0) {
    ++counts_.invalid_column;
  } else if (measurement_id >= columns_per_frame_) {
    ++counts_.bad_measurement_id;
  } else if (framing.column_frame_id.present() && framing.column_frame_id.get(column) != packet.frame_id) {
    ++counts_.bad_column_frame_id;
  } else {
    packet.storage[packet.count++] = {framing.timestamp_ns.get(column), measurement_id,
                                      column + framing.column_header_bytes};
  }
}

}  // namespace lxd
