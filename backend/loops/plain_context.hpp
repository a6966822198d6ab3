// SPDX-License-Identifier: Apache-2.0
// Scan Context as Kim and Kim wrote it (IROS 2018): the highest surface of each polar bin, column-wise cosine distance,
// no masks. Only for comparison with the extended one.
#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "backend/loops/surfels.hpp"

namespace lxd {

struct PlainContext {
  static constexpr int kRings = 20, kSectors = 60;
  Eigen::Array<float, kRings, kSectors> height_m = Eigen::Array<float, kRings, kSectors>::Zero();  // above the ground
};

struct PlainMatch {
  double distance = 1;
  int shift = 0;  // sectors
};

PlainContext make_plain_context(std::span<const Surfel> surfels, const Eigen::Vector3d& place_m, double radius_max_m,
                                double carrier_height_m);
PlainMatch match_plain(const PlainContext& query, const PlainContext& candidate);

}  // namespace lxd
