// SPDX-License-Identifier: Apache-2.0
// See ouster_stream.hpp.
#include "drivers/replay/ouster_stream.hpp"

#include "drivers/ouster/packet_parser.hpp"
#include "drivers/replay/datagram_capture.hpp"

namespace lxd {
namespace {

constexpr int kSearchedDatagrams = 1000;  // about a second of one sensor

}  // namespace

std::optional<OusterStream> find_ouster_stream(PcapFile pcap, const OusterMetadata& metadata) {
  OusterPacketParser parser(metadata.format, metadata.columns_per_frame, metadata.init_id, metadata.serial);
  OusterPacket packet;
  DatagramCapture capture(std::move(pcap));
  Rejections counted_when_read;
  std::optional<OusterStream> first;
  for (int datagrams = 0; datagrams < kSearchedDatagrams; ++datagrams) {
    const auto datagram = capture.next(counted_when_read);
    if (!datagram) break;
    if (!parser.parse(datagram->udp.payload, packet)) continue;
    const OusterStream stream = stream_of(datagram->udp);
    if (!metadata.lidar_port || stream.destination_port == *metadata.lidar_port) return stream;
    if (!first) first = stream;
  }
  return first;
}

}  // namespace lxd
