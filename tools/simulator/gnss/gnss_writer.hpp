// SPDX-License-Identifier: Apache-2.0
// The receiver of a recording: gnss.nmea, `<host time s> <sentence>` a line.
#pragma once

#include <array>
#include <filesystem>
#include <span>

#include "rt/result.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/gnss/gnss_config.hpp"

namespace lxd::sim {

struct GnssLog {
  std::uint64_t epochs = 0, sentences = 0;
  std::uint64_t none = 0, single = 0, rtk_float = 0, rtk_fixed = 0;  // of the epochs
};

std::span<const KnownFault> gnss_faults();

// Error: a serial line that is too slow for its sentences.
Status check_gnss(const GnssConfig& config);

// Errors name the file: check_gnss()'s, an origin that is no place, whatever cannot be written. No file is left then.
Result<GnssLog> write_gnss(const Context& context, const GnssConfig& config, const std::filesystem::path& folder);

}  // namespace lxd::sim
