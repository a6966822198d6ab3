// SPDX-License-Identifier: Apache-2.0
// Ouster packets for tests: those of a capture, and made ones.
#pragma once

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/crc.hpp"
#include "drivers/ouster/metadata.hpp"
#include "drivers/replay/ip_reassembler.hpp"
#include "drivers/replay/ouster_metadata_file.hpp"
#include "drivers/replay/pcap_file.hpp"
#include "tests/support/replay_files.hpp"

namespace lxd::replay_test {

using Packet = std::vector<std::uint8_t>;

// Every datagram of `bytes` bytes in the capture.
inline std::vector<Packet> datagrams(const std::filesystem::path& pcap, std::size_t bytes) {
  std::vector<Packet> packets;
  auto file = PcapFile::open(pcap);
  if (!file) {
    ADD_FAILURE() << file.error().message;
    return packets;
  }
  IpReassembler reassembler;
  CapturedPacket captured;
  Rejections rejected;
  while (file->next(captured, rejected)) {
    const auto datagram = reassembler.add(captured.ipv4);
    if (datagram && datagram->payload.size() == bytes) {
      packets.emplace_back(datagram->payload.begin(), datagram->payload.end());
    }
  }
  return packets;
}

inline OusterMetadata must_read_metadata(const std::filesystem::path& json) {
  auto metadata = read_ouster_metadata(json);
  if (!metadata) {
    ADD_FAILURE() << metadata.error().message;
    return {};
  }
  return std::move(*metadata);
}

// A sensor of `rows` beams spread over +-20 degrees, without beam offsets.
inline OusterMetadata made_metadata(const char* profile, std::uint16_t columns = 64, std::uint16_t rows = 4) {
  OusterMetadata metadata;
  metadata.format = {find_ouster_profile(profile), 16, rows};
  metadata.columns_per_frame = columns;
  metadata.rate_hz = 10;
  metadata.init_id = 77;
  for (int row = 0; row < rows; ++row) {
    metadata.altitude_rad.push_back(0.35 - 0.7 * row / std::max(1, rows - 1));
    metadata.azimuth_rad.push_back(0);
    metadata.pixel_shift.push_back(0);
  }
  return metadata;
}

// A packet whose pixels all read range_mm; column times are 1 us apart from first_ns on.
inline Packet made_packet(const OusterMetadata& metadata, std::uint32_t frame_id, std::uint16_t first_column,
                          std::uint64_t first_ns, std::uint32_t range_mm, std::uint32_t init_id = 77) {
  const OusterPacketFormat& format = metadata.format;
  const OusterFraming& framing = format.framing();
  Packet packet(format.packet_bytes());
  framing.packet_type.set(packet.data(), kOusterLidarPacket);
  framing.packet_frame_id.set(packet.data(), frame_id);
  framing.init_id.set(packet.data(), init_id);
  for (std::uint16_t c = 0; c < format.columns_per_packet; ++c) {
    std::uint8_t* const column = packet.data() + format.column_offset(c);
    framing.timestamp_ns.set(column, first_ns + 1000U * c);
    framing.measurement_id.set(column, first_column + c);
    framing.column_frame_id.set(column, frame_id);
    framing.header_status.set(column, 1);
    framing.footer_status.set(column + format.column_bytes() - framing.column_footer_bytes, 0xFFFFFFFF);
    for (std::size_t row = 0; row < format.pixels_per_column; ++row) {
      std::uint8_t* const block = column + framing.column_header_bytes + row * format.profile->channel_bytes;
      format.profile->fields.range_mm.set(block, range_mm);
      format.profile->fields.reflectivity.set(block, 50);
    }
  }
  if (framing.crc.present()) {
    framing.crc.set(packet.data() + format.footer_offset(), crc64(std::span(packet).first(packet.size() - 8)));
  }
  return packet;
}

// A packet on its way.
struct SentPacket {
  Packet payload;
  std::uint16_t source_address_low = 0;  // the last two bytes of the sender's address
  std::uint16_t port = 7502;             // destination
};

// A capture (Ethernet, microseconds) of the datagrams, each in IPv4 fragments of at most fragment_bytes, a multiple
// of 8.
inline std::vector<std::uint8_t> made_pcap(const std::vector<SentPacket>& packets, std::size_t fragment_bytes) {
  std::vector<std::uint8_t> file;
  const auto little = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) file.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  };
  const auto big = [](std::vector<std::uint8_t>& to, std::size_t value) {
    to.push_back(static_cast<std::uint8_t>(value >> 8U));
    to.push_back(static_cast<std::uint8_t>(value));
  };
  for (const std::uint32_t word : {0xA1B2C3D4U, 0x00040002U, 0U, 0U, 65535U, 1U}) little(word, 4);
  std::size_t id = 0;
  for (const auto& [packet, source, port] : packets) {
    Packet udp;
    for (const std::size_t word : {std::size_t{7502}, std::size_t{port}, packet.size() + 8, std::size_t{0}})
      big(udp, word);
    udp.insert(udp.end(), packet.begin(), packet.end());
    for (std::size_t at = 0; at < udp.size(); at += fragment_bytes) {
      const std::size_t bytes = std::min(fragment_bytes, udp.size() - at);
      Packet frame;
      frame.reserve(64 + bytes);
      frame.resize(12);
      big(frame, 0x0800);
      big(frame, 0x4500);
      big(frame, 20 + bytes);
      big(frame, id);
      big(frame, at / 8 | (at + bytes < udp.size() ? 0x2000U : 0U));
      big(frame, 0x4011);              // time to live, UDP
      frame.resize(frame.size() + 4);  // check sum, and the address's first half
      big(frame, source);
      frame.resize(frame.size() + 4);
      const auto begin = udp.begin() + static_cast<std::ptrdiff_t>(at);
      frame.insert(frame.end(), begin, begin + static_cast<std::ptrdiff_t>(bytes));
      little(0, 4);
      little(0, 4);
      little(static_cast<std::uint32_t>(frame.size()), 4);
      little(static_cast<std::uint32_t>(frame.size()), 4);
      file.insert(file.end(), frame.begin(), frame.end());
    }
    ++id;
  }
  return file;
}

inline std::vector<std::uint8_t> made_pcap(const std::vector<Packet>& packets, std::size_t fragment_bytes) {
  std::vector<SentPacket> sent;
  for (const Packet& packet : packets) sent.push_back({packet});
  return made_pcap(sent, fragment_bytes);
}

}  // namespace lxd::replay_test
