// SPDX-License-Identifier: Apache-2.0
// The configuration in force as a rig file: what was given and every default, so that a run can be repeated from its
// folder alone. Reading it back gives the same rig and the same settings, to the last bit.
#pragma once

#include <string>

#include "board/rig.hpp"
#include "board/settings.hpp"

namespace lxd {

// As T_reference_sensor is written.
std::string transform_text(const Pose& T);

std::string rig_text(const Rig& rig, const Settings& settings);

// The rig alone: the rig file of a recording.
std::string rig_text(const Rig& rig);

}  // namespace lxd
