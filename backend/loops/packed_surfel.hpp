// SPDX-License-Identifier: Apache-2.0
// A surface element in ten bytes, for keeping whole maps' worth of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "backend/loops/surfels.hpp"

namespace lxd {

struct PackedSurfel {
  static constexpr float kStep_m = 0.005F;        // of the position: 1.4 mm (sigma), up to 163 m from the origin
  static constexpr float kSigmaStep_m = 0.0005F;  // of the standard deviation, up to 12.7 cm

  std::array<std::int16_t, 3> position{};
  std::array<std::int8_t, 3> normal{};
  std::uint8_t sigma = 0;

  static bool fits(const Surfel& s) { return s.position_m.cwiseAbs().maxCoeff() < 32767 * kStep_m; }

  static PackedSurfel pack(const Surfel& s) {
    PackedSurfel out;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      out.position[i] = static_cast<std::int16_t>(std::lround(s.position_m[axis] / kStep_m));
      out.normal[i] = static_cast<std::int8_t>(std::lround(s.normal[axis] * 127));
    }
    out.sigma = static_cast<std::uint8_t>(std::min(255L, std::lround(std::sqrt(s.variance_m2) / kSigmaStep_m)));
    return out;
  }

  [[nodiscard]] Surfel unpack() const {
    const float sigma_m = sigma * kSigmaStep_m;
    const Eigen::Vector3f p(position[0], position[1], position[2]), n(normal[0], normal[1], normal[2]);
    return {p * kStep_m, n.normalized(), sigma_m * sigma_m, 0};
  }
};
static_assert(sizeof(PackedSurfel) == 10);

}  // namespace lxd
