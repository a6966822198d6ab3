// SPDX-License-Identifier: Apache-2.0
// Is a loop candidate true, and where was the key frame then? Plan search, registration, and the tests that a false
// candidate fails; the covariance of what passes them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "backend/loops/plan_search.hpp"
#include "backend/loops/registration.hpp"
#include "backend/loops/scan_context.hpp"
#include "backend/loops/surfels.hpp"

namespace lxd {

struct VerificationConfig {
  PlanSearchConfig plan;
  RegistrationConfig registration;
  double radius_m = 45;           // of what is compared about the key frames
  double query_voxel_m = 0.5;     // what is registered and counted is thinned to this
  int surfels_max = 4000;         // and taken in turns beyond this many
  double overlap_min = 0.6;       // least share of either's standing surfaces, where the other has seen, that agree
  int surfels_min = 150;          // standing ones that were seen by both
  double agree_m = 0.15;          // along the normal
  double rms_max_m = 0.08;        // of the residuals
  double moved_max_m = 3.0;       // by the registration from what the plan search found
  double rival_max = 0.95;        // score of a second place in the plan, of the first's
  double open_sigma_max_m = 0.5;  // along the worst direction; more is no loop to trust
  double rows_per_look = 20;      // residuals that err alike: their surfaces came from the same sweeps
  double drift_sigma_m = 0.02;    // of a key frame in its sub-mesh
  double drift_sigma_rad = 0.001;
};

enum class LoopVerdict : std::uint8_t { accepted, little_seen, little_overlap, poor_fit, moved_away, ambiguous, open };

struct Verification {
  LoopVerdict verdict = LoopVerdict::little_seen;
  Pose T_candidate_query;                      // of the two level frames
  Matrix6d covariance = Matrix6d::Identity();  // [rotation (right), position], as LoopMeasurement has it
  double overlap = 0, rms_m = 0, plan_score = 0, rival_score = 0, open_sigma_m = 0;
};

// A key frame's surroundings, level and relative to it, with the descriptor made of them.
struct Surroundings {
  std::vector<Surfel> surfels;
  ScanContext context;
  double height_m = 0;  // of the key frame above the ground
};

Surroundings surroundings_of(std::span<const Surfel> submesh, const Eigen::Vector3d& place_m,
                             const ScanContext& context, double radius_m);

Verification verify_loop(const Surroundings& query, const Surroundings& candidate, double yaw_guess_rad,
                         const ContextConfig& context_config, const VerificationConfig& config);

// What is known of a direction is believed by the share in which it exceeds what errors of the normals explain; what
// they explain is left open (1 rad, 10 m).
Matrix6d honest_covariance(const Registration& registration, const VerificationConfig& config);

}  // namespace lxd
