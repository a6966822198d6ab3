// SPDX-License-Identifier: Apache-2.0
// Which JSON file beside a capture is the sensor's metadata.
#pragma once

#include <filesystem>

#include "drivers/ouster/metadata.hpp"
#include "rt/result.hpp"

namespace lxd {

// For NAME.pcap, the first of: NAME.json; NAME_0.json; the longest STEM.json with which NAME begins; the folder's only
// .json. Errors: none of them (lists the folder's .json files).
Result<std::filesystem::path> find_ouster_metadata(const std::filesystem::path& pcap);

// Errors: unreadable, bigger than any metadata, and what parse_ouster_metadata refuses.
Result<OusterMetadata> read_ouster_metadata(const std::filesystem::path& json);

}  // namespace lxd
