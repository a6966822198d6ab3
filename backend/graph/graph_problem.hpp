// SPDX-License-Identifier: Apache-2.0
// One least-squares problem of poses and factors, and its solution by Ceres. Made anew for each solution: a window, the
// sub-meshes, or all key frames.
#pragma once

#include <optional>
#include <vector>

#include "backend/graph/factors.hpp"

namespace lxd {

struct GraphProblem {
  struct Relative {
    int a, b;  // nodes
    RelativeFactor factor;
    double robust = 0;  // width of its Huber kernel in sigmas; 0: none
  };
  struct Gnss {
    int node;
    GnssFactor factor;
    double robust = 0;  // width of its Huber kernel in (whitened) sigmas; 0: none
  };
  struct Tilt {
    int node;
    TiltFactor factor;
  };

  std::vector<Pose> poses;  // T_map_node; begin and result
  std::vector<bool> held;   // nodes that stay; empty: none
  std::vector<Relative> relative;
  std::vector<Gnss> gnss;
  std::vector<Tilt> tilt;
  std::optional<AnchorFactor> anchor;  // of node 0
  EarthAlignment alignment;            // begin and result
  bool alignment_held = false;
  double delay_expected_s = 0, delay_sigma_s = 1;
};

struct SolverEffort {
  int iterations_max;
  double cost_tolerance;  // ends when one iteration gains less of the cost than this share
};

struct GraphSolution {
  double initial_cost = 0, final_cost = 0;
  int iterations = 0;
  bool usable = false;  // otherwise the problem is as it was
};

// Levenberg-Marquardt over a sparse Cholesky factorization, in the calling thread: the same problem gives the same
// bits.
GraphSolution solve(GraphProblem& problem, const SolverEffort& effort);

// Half the sum of squares, robust kernels applied.
double cost_of(const GraphProblem& problem);

}  // namespace lxd
