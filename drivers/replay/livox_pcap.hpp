// SPDX-License-Identifier: Apache-2.0
// Sweeps of one Livox sensor (SDK2) out of a capture file, through the parser and sweep builder of the live sensor.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "drivers/replay/source.hpp"
#include "drivers/replay/sweep_clock.hpp"

namespace lxd {

// The sensor is the first whose point packets the capture holds; what others send is counted ("other_sensor"). Stamps
// are placed by `clock`; a sweep's stamp is its end. Errors: no readable capture.
Result<std::unique_ptr<SweepSource>> open_livox_pcap(const std::filesystem::path& pcap,
                                                     std::unique_ptr<SweepClock> clock, const std::string& kind);

// Whether the capture's first datagrams hold point packets of a Livox sensor.
bool has_livox_points(const std::filesystem::path& pcap);

}  // namespace lxd
