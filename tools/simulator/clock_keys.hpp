// SPDX-License-Identifier: Apache-2.0
// The `clock:` of a sensor in a scenario.
#pragma once

#include "board/yaml_section.hpp"
#include "tools/simulator/clock.hpp"

namespace lxd::sim {

void read_keys(YamlSection& section, ClockConfig& clock);

}  // namespace lxd::sim
