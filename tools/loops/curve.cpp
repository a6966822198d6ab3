// SPDX-License-Identifier: Apache-2.0
#include "tools/loops/curve.hpp"

#include <algorithm>
#include <cstddef>

namespace lxd {

Curve precision_recall(std::vector<ScoredPair> pairs) {
  constexpr std::size_t kPointsMax = 200;
  std::sort(pairs.begin(), pairs.end(),
            [](const ScoredPair& a, const ScoredPair& b) { return a.distance < b.distance; });
  const auto all_same =
      static_cast<double>(std::count_if(pairs.begin(), pairs.end(), [](const ScoredPair& p) { return p.same; }));
  Curve out;
  double found = 0, taken = 0, recall_before = 0;
  const std::size_t step = std::max<std::size_t>(1, pairs.size() / kPointsMax);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    found += pairs[i].same ? 1 : 0;
    taken += 1;
    const bool tie = i + 1 < pairs.size() && pairs[i + 1].distance == pairs[i].distance;
    if (tie || all_same == 0) continue;
    const CurvePoint point{pairs[i].distance, found / taken, found / all_same};
    out.average_precision += point.precision * (point.recall - recall_before);
    recall_before = point.recall;
    if (found == taken) {
      out.recall_at_full_precision = point.recall;
      out.threshold_at_full_precision = point.threshold;
    }
    if (i % step == 0) out.points.push_back(point);
  }
  return out;
}

}  // namespace lxd
