// SPDX-License-Identifier: Apache-2.0
// Fixes in the problems of the graph. What lasts of their errors is unknown at knots of equal distance in time; where
// that would be more unknowns than poses, fixes that err alike count for less instead.
#pragma once

#include "backend/graph/graph_state.hpp"

namespace lxd {

// Odometry's drift, whether there is any, and how long the fixes' errors last, by the fixes that there are.
void learn_noise_levels(GraphState& state);

// Fixes of the key frames from `first` on, which are the problem's first nodes. From a later one than the very first
// on, what lasts of the errors is held where that begins.
void add_fixes(const GraphState& state, int first, GraphProblem& problem);
void take_lasting(const GraphProblem& solved, int first, GraphState& state);

// Some of the fixes; nodes are the sub-meshes.
void add_coarse_fixes(const GraphState& state, GraphProblem& problem);

}  // namespace lxd
