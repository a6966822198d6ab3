// SPDX-License-Identifier: Apache-2.0
// IPv4 packets of a capture file, one by one, through libpcap.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

#include "drivers/replay/rejections.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"

struct pcap;

namespace lxd {

struct CapturedPacket {
  RigTime received;                    // kernel receive time, since 1970
  std::span<const std::uint8_t> ipv4;  // from the IP header on; valid until the next read
};

class PcapFile {
 public:
  // Errors: not readable, no capture file, a link type other than Ethernet, Linux cooked (1, 2) and raw IP.
  static Result<PcapFile> open(const std::filesystem::path& path);
  // Takes the stream over; name is for messages.
  static Result<PcapFile> from_stream(std::FILE* stream, const std::string& name);

  // False at the end. Other protocols are passed over; a record that the capture cut short is counted
  // ("short_capture"), a file that ends within a record too ("truncated_file").
  bool next(CapturedPacket& packet, Rejections& rejected);

 private:
  struct Close {
    void operator()(pcap* handle) const;
  };
  PcapFile(pcap* handle, int link_type) : handle_(handle), link_type_(link_type) {}

  std::unique_ptr<pcap, Close> handle_;
  int link_type_ = 0;
};

}  // namespace lxd
