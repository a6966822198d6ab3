// SPDX-License-Identifier: Apache-2.0
// See ouster_stream.hpp.
#include "drivers/replay/ouster_stream.hpp"

#include "drivers/ouster/packet_parser.hpp"

namespace lxd {
namespace {

constexpr int kSearchedDatagrams = 1000;  // about a second of one sensor

}  // namespace

std::optional<OusterStream> find_ouster_stream(PcapFile& pcap, const OusterMetadata& metadata) {
  OusterPacketParser parser(metadata.format, metadata.columns_per_frame, metadata.init_id, metadata.serial);
  OusterPacket packet;
  IpReassembler reassembler;
  CapturedPacket captured;
  Rejections counted_when_read;
  std::optional<OusterStream> first;
  for (int datagrams = 0; datagrams < kSearchedDatagrams && pcap.next(captured, counted_when_read);) {
    const auto datagram = reassembler.add(captured.ipv4);
    if (!datagram) continue;
    ++datagrams;
    if (!parser.parse(datagram->payload, packet)) continue;
    if (!metadata.lidar_port || datagram->destination_port == *metadata.lidar_port) return stream_of(*datagram);
    if (!first) first = stream_of(*datagram);
  }
  return first;
}

}  // namespace lxd
