// SPDX-License-Identifier: Apache-2.0
// Sweeps of one Livox sensor (SDK2 or SDK1) out of a capture file, through the parser and sweep builder of the live
// one.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "drivers/replay/source.hpp"
#include "drivers/replay/sweep_clock.hpp"

namespace lxd {

// The sensor is the first whose point packets the capture holds; what others send is counted ("other_sensor"). Stamps
// are placed by `clock` (null: sensor time from the first sweep on); a sweep's stamp is its end. Errors: no readable
// capture, or one without such packets.
Result<std::unique_ptr<SweepSource>> open_livox_pcap(const std::filesystem::path& pcap,
                                                     std::unique_ptr<SweepClock> clock, const std::string& kind);

}  // namespace lxd
