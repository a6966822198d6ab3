// SPDX-License-Identifier: Apache-2.0
// The UDP datagrams of a capture file, whole and in the order of their last pieces: what every LiDAR's source reads.
#pragma once

#include <optional>

#include "drivers/replay/ip_reassembler.hpp"
#include "drivers/replay/pcap_file.hpp"

namespace lxd {

struct ReceivedDatagram {
  RigTime received;  // of its last piece
  UdpDatagram udp;   // valid until the next
};

class DatagramCapture {
 public:
  explicit DatagramCapture(PcapFile pcap) : pcap_(std::move(pcap)) {}

  // Nothing: the capture is over. What the file itself lacks is counted at once.
  std::optional<ReceivedDatagram> next(Rejections& rejected) {
    CapturedPacket packet;
    while (pcap_.next(packet, rejected)) {
      if (const auto datagram = reassembler_.add(packet.ipv4)) return ReceivedDatagram{packet.received, *datagram};
    }
    reassembler_.finish();
    return std::nullopt;
  }

  // What was wrong with pieces so far: "malformed_ip", "incomplete_datagram".
  void report(Rejections& rejected) const {
    set_rejected(rejected, {{"malformed_ip", reassembler_.counts().malformed},
                            {"incomplete_datagram", reassembler_.counts().incomplete}});
  }

 private:
  PcapFile pcap_;
  IpReassembler reassembler_;
};

}  // namespace lxd
