// SPDX-License-Identifier: Apache-2.0
// A capture file as a host that listens on Ethernet writes it: nanoseconds, receive stamps that never run backwards.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "rt/result.hpp"
#include "rt/time.hpp"
#include "tools/simulator/lidar/udp_frames.hpp"

struct pcap;
struct pcap_dumper;

namespace lxd::sim {

class PcapWriter {
 public:
  static Result<PcapWriter> create(const std::filesystem::path& path);

  // The first frame comes at `received`, or when the wire is free again (1 Gbit/s); the rest follow. `lost_fragment`:
  // this frame, counted from 0 and folded to their number, never comes.
  Status write(const UdpRoute& route, std::span<const std::uint8_t> payload, RigTime received,
               std::optional<std::uint64_t> lost_fragment = std::nullopt);
  // Flushes to the disk. Errors (a full disk) may show here only: a file that was not closed well is not whole.
  Status close();

 private:
  struct CloseDumper {
    void operator()(pcap_dumper* dumper) const;
  };
  struct ClosePcap {
    void operator()(pcap* handle) const;
  };
  PcapWriter(std::filesystem::path path, pcap* handle, pcap_dumper* dumper, std::FILE* stream)
      : path_(std::move(path)), handle_(handle), dumper_(dumper), stream_(stream) {}
  void write_frame(std::span<const std::uint8_t> frame);
  [[nodiscard]] Status failure() const;

  std::filesystem::path path_;
  std::unique_ptr<pcap, ClosePcap> handle_;
  std::unique_ptr<pcap_dumper, CloseDumper> dumper_;
  std::FILE* stream_;  // dumper_'s
  int cause_ = 0;      // errno of the first failure
  UdpFramer framer_;
  RigTime wire_free_;
};

}  // namespace lxd::sim
