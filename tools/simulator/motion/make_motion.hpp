// SPDX-License-Identifier: Apache-2.0
// From a scenario's words to its motion.
#pragma once

#include <cstdint>

#include "rt/result.hpp"
#include "tools/simulator/motion/motion_config.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

// The motion that a scenario asks for; covers [-1 s, duration + 1 s]. Errors: no such carrier or route, a route without
// length, a speed beyond the carrier's, a duration that is none, and whatever is wrong with a recorded path.
Result<Trajectory> make_motion(const MotionConfig& config, const World& world, std::uint64_t seed, double duration_s);

}  // namespace lxd::sim
