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
    double robust;     // width of its Huber kernel in (whitened) sigmas
    std::size_t knot;  // of `lasting`, the one before it; there is one after
    double toward;     // of the way from that knot to the next, 0 to 1
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
  // Of the fixes' errors, at knots of equal distance, linear in between: begin and result.
  std::vector<Eigen::Vector3d> lasting;
  LastingFactor lasting_factor{0};  // from knot to knot
  bool first_lasting_held = false;  // otherwise it is of unit variance
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
