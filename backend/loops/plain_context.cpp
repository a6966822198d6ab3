// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/plain_context.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lxd {

PlainContext make_plain_context(std::span<const Surfel> surfels, const Eigen::Vector3d& place_m, double radius_max_m,
                                double carrier_height_m) {
  PlainContext out;
  for (const Surfel& s : surfels) {
    const Eigen::Vector3d d = s.position_m.cast<double>() - place_m;
    const double r = d.head<2>().norm();
    if (!(r < radius_max_m)) continue;
    const int ring = static_cast<int>(r / radius_max_m * PlainContext::kRings);
    const double turn = std::atan2(d.y(), d.x()) / (2 * std::numbers::pi) + 1;
    const int sector = static_cast<int>(turn * PlainContext::kSectors) % PlainContext::kSectors;
    float& top = out.height_m(ring, sector);
    top = std::max(top, static_cast<float>(d.z() + carrier_height_m));
  }
  return out;
}

PlainMatch match_plain(const PlainContext& query, const PlainContext& candidate) {
  PlainMatch best;
  for (int shift = 0; shift < PlainContext::kSectors; ++shift) {
    double sum = 0;
    int columns = 0;
    for (int i = 0; i < PlainContext::kSectors; ++i) {
      const auto q = query.height_m.col(i).matrix();
      const auto c = candidate.height_m.col((i + shift) % PlainContext::kSectors).matrix();
      const float norms = q.norm() * c.norm();
      if (!(norms > 0)) continue;  // a column without anything has no direction: left out, as in the paper's code
      sum += 1.0 - static_cast<double>(q.dot(c) / norms);
      ++columns;
    }
    if (columns > 0 && sum / columns < best.distance) best = {sum / columns, shift};
  }
  return best;
}

}  // namespace lxd
