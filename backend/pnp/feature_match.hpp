// SPDX-License-Identifier: Apache-2.0
// Which features of two images are the same thing, by their descriptors alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "backend/pnp/visual_key_frame.hpp"

namespace lxd {

struct FeatureMatchConfig {
  int distance_max = 64;    // of 256 bits
  double ratio_max = 0.85;  // to the second best
};

struct FeatureMatch {
  std::uint32_t historical, current;  // indices
};

int hamming(const OrbDescriptor& a, const OrbDescriptor& b);

// Each other's best, clearly better than the second.
std::vector<FeatureMatch> match_features(std::span<const VisualFeature> historical,
                                         std::span<const VisualFeature> current, const FeatureMatchConfig& config);

}  // namespace lxd
