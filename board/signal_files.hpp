// SPDX-License-Identifier: Apache-2.0
// The files of a recording that pulses and triggers go into: pps.csv and gpio.csv, as the simulator writes them, too.
#pragma once

#include <filesystem>
#include <memory>

#include "board/chunk_file.hpp"
#include "board/sync_wires.hpp"
#include "drivers/sync/gpio_edges.hpp"

namespace lxd {

// Errors: it cannot be made.
Result<std::unique_ptr<ChunkFile>> create_pulse_file(const PulseRig& rig, const std::filesystem::path& path);
Result<std::unique_ptr<ChunkFile>> create_trigger_file(const TriggersRig& rig, const std::filesystem::path& path);

// The edge of a GPIO line at which the second begins, or that triggers.
GpioEdge begins_at(const PulseRig& rig);
GpioEdge triggers_at(const TriggersRig& rig);

}  // namespace lxd
