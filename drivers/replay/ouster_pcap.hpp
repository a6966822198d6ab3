// SPDX-License-Identifier: Apache-2.0
// Sweeps of one Ouster sensor out of a capture file: the parser, assembler and sweep builder that a live sensor feeds,
// fed from a file.
#pragma once

#include <filesystem>
#include <memory>

#include "drivers/ouster/metadata.hpp"
#include "drivers/replay/pcap_file.hpp"
#include "drivers/replay/source.hpp"

namespace lxd {

bool looks_like_pcap(const std::filesystem::path& file);  // by its first four bytes; pcapng too

// Rig time zero is the first column's time in the capture; a sweep's stamp is its end. Errors: capture or metadata not
// readable.
Result<std::unique_ptr<SweepSource>> open_ouster_pcap(const std::filesystem::path& pcap);

// The same over parts that are open already.
std::unique_ptr<SweepSource> make_ouster_source(PcapFile pcap, const OusterMetadata& metadata);

}  // namespace lxd
