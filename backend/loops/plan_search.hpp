// SPDX-License-Identifier: Apache-2.0
// The coarse step of loop verification: where the standing surfaces of one place, seen from above, lie best upon those
// of another, over a window of positions and headings. Exhaustive, so that no start is too far off within the window.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "backend/loops/surfels.hpp"

namespace lxd {

struct PlanSearchConfig {
  double cell_m = 0.5;
  double window_m = 8;           // each way
  double yaw_window_rad = 0.09;  // each way: a sector, nearly
  double yaw_step_rad = 0.03;
  double rival_m = 2.5;  // a best place farther from the best than this is another one
};

struct PlanFit {
  double yaw_rad = 0;
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
  double score = 0;  // share of the query's elements that lie upon one of the candidate's, 0..1
  double rival = 0;  // score of the best place elsewhere
};

// Both level, each about its own key frame; the fit takes the query's points to the candidate's axes.
PlanFit search_plan(std::span<const Surfel> query, std::span<const Surfel> candidate, double yaw_guess_rad,
                    const PlanSearchConfig& config);

}  // namespace lxd
