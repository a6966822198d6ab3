// SPDX-License-Identifier: Apache-2.0
// What every transport looks like to the thread that drives it: a file descriptor to poll, a read that never blocks,
// and a call now and then in which a device that went away comes back. No device has a thread of its own, and none of
// them knows what its bytes mean. One thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "rt/time.hpp"

namespace lxd {

// What a camera's driver says of a frame.
struct FrameOrigin {
  std::uint32_t sequence = 0;        // its count since it began
  std::uint32_t bytes_per_line = 0;  // 0: lines have no gaps
  bool at_start = false;             // its stamp is of the exposure's start; else of the frame's end
};

// Where a datagram came from and where it was sent to (IPv4, host byte order), or what is said of a frame; zeros for
// other transports.
struct ChunkOrigin {
  std::uint32_t source_address = 0, destination_address = 0;
  std::uint16_t source_port = 0, destination_port = 0;
  FrameOrigin frame{};
};

// A datagram, a CAN frame (drivers/device/can_wire.hpp), what one read of a serial line gave, an image, or an edge
// (drivers/sync/pulse_wire.hpp).
struct Chunk {
  RigTime received;  // the kernel's stamp where it gives one, else when it was read
  ChunkOrigin origin;
  std::uint8_t channel = 0;             // as the device's owner numbered its source
  std::span<const std::uint8_t> bytes;  // valid during take()
};

class ChunkSink {
 public:
  virtual ~ChunkSink() = default;
  virtual void take(const Chunk& chunk) = 0;
};

struct DeviceCounts {
  std::uint64_t chunks = 0, bytes = 0;  // delivered
  std::uint64_t kernel_overflow = 0;    // lost by the kernel, because nobody read in time
  std::uint64_t cut = 0;                // datagrams longer than any that is expected: left out
  std::uint64_t foreign = 0;            // datagrams of another address: left out
  std::uint64_t no_stamp = 0;           // delivered with the time of reading, as the kernel gave none
  std::uint64_t read_errors = 0;        // that neither ended nor hindered the device
  std::uint64_t openings = 0, departures = 0;
  std::uint64_t error_frames = 0, error_passive = 0, bus_off = 0, bus_back = 0;  // CAN
};

// By the names that a report gives them.
inline constexpr std::array<std::pair<const char*, std::uint64_t DeviceCounts::*>, 12> kDeviceCountNames{{
    {"chunks", &DeviceCounts::chunks},
    {"bytes", &DeviceCounts::bytes},
    {"kernel_overflow", &DeviceCounts::kernel_overflow},
    {"cut", &DeviceCounts::cut},
    {"foreign", &DeviceCounts::foreign},
    {"no_stamp", &DeviceCounts::no_stamp},
    {"read_error", &DeviceCounts::read_errors},
    {"departure", &DeviceCounts::departures},
    {"error_frame", &DeviceCounts::error_frames},
    {"error_passive", &DeviceCounts::error_passive},
    {"bus_off", &DeviceCounts::bus_off},
    {"bus_back", &DeviceCounts::bus_back},
}};

class Device {
 public:
  virtual ~Device() = default;

  [[nodiscard]] virtual const std::string& name() const = 0;  // for messages: "/dev/ttyUSB0", "can0", "udp 7502"
  // To poll for reading; -1 while the device is away.
  [[nodiscard]] virtual int fd() const = 0;
  // Hands over what waits, at most kChunksPerRead chunks; never blocks. When the device turns out to be gone it is
  // closed, and tend() looks for it.
  virtual void read(ChunkSink& sink) = 0;
  // Opens what is away, at growing intervals. To be called every 100 ms or so.
  virtual void tend(RigTime now) = 0;
  // Why it is away; empty while it is there.
  [[nodiscard]] virtual const std::string& trouble() const = 0;
  [[nodiscard]] virtual const DeviceCounts& counts() const = 0;
  // What it counts besides, by the names that a report gives them; no read is under way. Allocates.
  virtual void add_counts(std::map<std::string, std::uint64_t>& counts) const { (void)counts; }

  static constexpr int kChunksPerRead = 64;
};

}  // namespace lxd
