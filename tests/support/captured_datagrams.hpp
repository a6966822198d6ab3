// SPDX-License-Identifier: Apache-2.0
// The datagrams of a capture, reassembled, with what went wrong on the way.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/replay/ip_reassembler.hpp"
#include "drivers/replay/pcap_file.hpp"

namespace lxd::test {

struct CapturedDatagram {
  RigTime received;  // of its last frame
  std::uint32_t source_address = 0;
  std::uint16_t source_port = 0, port = 0;
  std::vector<std::uint8_t> bytes;
};

struct Capture {
  std::vector<CapturedDatagram> datagrams;
  std::vector<RigTime> frames;  // when each frame was received
  IpReassembler::Counts ip;
  Rejections rejected;

  [[nodiscard]] std::vector<const CapturedDatagram*> to(std::uint16_t port) const {
    std::vector<const CapturedDatagram*> found;
    for (const CapturedDatagram& datagram : datagrams) {
      if (datagram.port == port) found.push_back(&datagram);
    }
    return found;
  }
};

inline Capture read_capture(const std::filesystem::path& path) {
  Capture capture;
  auto file = PcapFile::open(path);
  if (!file) {
    ADD_FAILURE() << file.error().message;
    return capture;
  }
  IpReassembler reassembler;
  CapturedPacket packet;
  while (file->next(packet, capture.rejected)) {
    capture.frames.push_back(packet.received);
    if (const auto d = reassembler.add(packet.ipv4)) {
      capture.datagrams.push_back({packet.received,
                                   d->source_address,
                                   d->source_port,
                                   d->destination_port,
                                   {d->payload.begin(), d->payload.end()}});
    }
  }
  reassembler.finish();
  capture.ip = reassembler.counts();
  return capture;
}

}  // namespace lxd::test
