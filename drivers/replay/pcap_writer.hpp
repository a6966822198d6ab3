// SPDX-License-Identifier: Apache-2.0
// A capture file of UDP datagrams as a host that listens on Ethernet writes it, with nanoseconds: for the recorder and
// the simulator.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "drivers/replay/growing_file.hpp"
#include "drivers/replay/udp_frames.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

enum class PcapStamps : std::uint8_t {
  as_given,  // all frames of a datagram have its stamp
  of_wire    // a frame comes when the wire, 1 Gbit/s, is free again: stamps never run backwards
};

class PcapWriter {
 public:
  static Result<PcapWriter> create(const std::filesystem::path& path, PcapStamps stamps);

  // `lost_fragment`: this frame, counted from 0 and folded to their number, never comes.
  Status write(const UdpRoute& route, std::span<const std::uint8_t> payload, RigTime received,
               std::optional<std::uint64_t> lost_fragment = std::nullopt);
  // Flushes to the disk. Errors (a full disk) may show here only: a file that was not closed well is not whole.
  Status close() { return file_.close(); }

  [[nodiscard]] GrowingFile& file() { return file_; }

 private:
  PcapWriter(GrowingFile file, PcapStamps stamps) : file_(std::move(file)), stamps_(stamps) {}
  Status write_frame(std::span<const std::uint8_t> frame, RigTime received);

  GrowingFile file_;
  PcapStamps stamps_;
  UdpFramer framer_;
  RigTime wire_free_;
};

}  // namespace lxd
