// SPDX-License-Identifier: Apache-2.0
// Sweeps of one Ouster sensor out of a capture file: the parser, assembler and sweep builder that a live sensor feeds,
// fed from a file.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "drivers/ouster/metadata.hpp"
#include "drivers/replay/ouster_stream.hpp"
#include "drivers/replay/pcap_file.hpp"
#include "drivers/replay/source.hpp"
#include "drivers/replay/sweep_clock.hpp"

namespace lxd {

bool looks_like_pcap(const std::filesystem::path& file);  // by its first four bytes; pcapng too

// A capture, what its sensor says of itself, and which packets of the capture are the sensor's.
struct OusterCapture {
  PcapFile pcap;  // at its first packet
  OusterMetadata metadata;
  std::optional<OusterStream> stream;  // none: none of the first packets is a LiDAR's
};
Result<OusterCapture> open_ouster_capture(const std::filesystem::path& path);

// One sensor's sweeps (ouster_stream.hpp). Rig time zero is its first column's time in the capture, and goes on over a
// restart of the sensor (stream_clock.hpp); a sweep's stamp is its end. Errors: capture or metadata not
// readable.
Result<std::unique_ptr<SweepSource>> open_ouster_pcap(const std::filesystem::path& pcap);

// The same of a rig recording, whose rig time is the host's: stamps are placed by `clock`; null: as above.
Result<std::unique_ptr<SweepSource>> open_ouster_pcap(const std::filesystem::path& pcap,
                                                      std::unique_ptr<SweepClock> clock, const std::string& kind);

// The same over parts that are open already. stream: the sensor's; none: the first that sends a LiDAR packet.
std::unique_ptr<SweepSource> make_ouster_source(PcapFile pcap, const OusterMetadata& metadata,
                                                std::optional<OusterStream> stream = std::nullopt);

}  // namespace lxd
