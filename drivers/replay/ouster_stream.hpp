// SPDX-License-Identifier: Apache-2.0
// One sensor's packets among those of several: packets of old firmware say nothing of who sent them, and columns of two
// sensors must never meet in one sweep.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/ouster/metadata.hpp"
#include "drivers/replay/ip_reassembler.hpp"
#include "drivers/replay/pcap_file.hpp"

namespace lxd {

struct OusterStream {
  std::uint32_t source_address = 0;  // IPv4
  std::uint16_t destination_port = 0;
  bool operator==(const OusterStream&) const = default;
};

inline OusterStream stream_of(const UdpDatagram& datagram) {
  return {datagram.source_address, datagram.destination_port};
}

// The first stream that sends LiDAR packets of the metadata's format to the metadata's port; when none does, captures
// being forwarded to other ports, the first to any port. Reads the capture's first datagrams, as far as it must; none:
// there was no such packet among them.
std::optional<OusterStream> find_ouster_stream(PcapFile pcap, const OusterMetadata& metadata);

}  // namespace lxd
