// SPDX-License-Identifier: Apache-2.0
// Which of a cell's waiting points lie on one surface? Principal components first (paper, "structural dimensionality
// assessment"); where the points are of two surfaces, the plane that most of them share is looked for.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "mapping/config.hpp"
#include "mapping/waiting_points.hpp"

namespace lxd {

struct PlaneCandidate {
  bool found = false;
  Eigen::Vector3f centre_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  // unit, sign arbitrary
  std::uint32_t members = 0;                          // bit i: points[i] lies on it
};

static_assert(kWaitingMax <= 32, "members is a 32-bit mask");

// points.size() <= kWaitingMax; noise_m2: variance of one of them. Deterministic: `seed` drives the choice of
// hypotheses.
PlaneCandidate search_plane(std::span<const Eigen::Vector3f> points_m, float noise_m2, const MappingConfig& config,
                            std::uint64_t seed);

}  // namespace lxd
