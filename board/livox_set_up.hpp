// SPDX-License-Identifier: Apache-2.0
// Livox sensors that this host sets up: their control protocol, as one more device, and ears at their ports, so that a
// sensor that sends no points is started again.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "board/live_rig.hpp"
#include "drivers/device/device.hpp"

namespace lxd {

// Nothing, when no Livox of the rig has a `host`. Otherwise every device there is hands over as before.
void set_up_livox(std::span<const LiveLidar> lidars, std::vector<std::unique_ptr<Device>>& devices);

}  // namespace lxd
