// SPDX-License-Identifier: Apache-2.0
#include "backend/pnp/feature_match.hpp"

#include <bit>
#include <cstring>
#include <limits>

namespace lxd {
namespace {

struct Best {
  int distance = std::numeric_limits<int>::max(), second = std::numeric_limits<int>::max();
  std::uint32_t index = 0;

  void offer(int offered, std::uint32_t at) {
    if (offered < distance) {
      second = distance;
      distance = offered;
      index = at;
    } else if (offered < second) {
      second = offered;
    }
  }
  [[nodiscard]] bool clear(const FeatureMatchConfig& config) const {
    return distance <= config.distance_max && distance < config.ratio_max * second;
  }
};

}  // namespace

int hamming(const OrbDescriptor& a, const OrbDescriptor& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t x = 0, y = 0;
    std::memcpy(&x, a.data() + i, sizeof x);
    std::memcpy(&y, b.data() + i, sizeof y);
    bits += std::popcount(x ^ y);
  }
  return bits;
}

std::vector<FeatureMatch> match_features(std::span<const VisualFeature> historical,
                                         std::span<const VisualFeature> current, const FeatureMatchConfig& config) {
  std::vector<Best> of_historical(historical.size()), of_current(current.size());
  for (std::uint32_t h = 0; h < historical.size(); ++h) {
    for (std::uint32_t c = 0; c < current.size(); ++c) {
      const int bits = hamming(historical[h].descriptor, current[c].descriptor);
      of_historical[h].offer(bits, c);
      of_current[c].offer(bits, h);
    }
  }
  std::vector<FeatureMatch> out;
  for (std::uint32_t h = 0; h < historical.size(); ++h) {
    const Best& best = of_historical[h];
    if (best.clear(config) && of_current[best.index].index == h && of_current[best.index].clear(config))
      out.push_back({h, best.index});
  }
  return out;
}

}  // namespace lxd
