// SPDX-License-Identifier: Apache-2.0
// Precision and recall of a detector that gives each pair of places a distance.
#pragma once

#include <vector>

namespace lxd {

struct ScoredPair {
  double distance = 0;
  bool same = false;  // truly one place
};

struct CurvePoint {
  double threshold = 0, precision = 0, recall = 0;
};

struct Curve {
  std::vector<CurvePoint> points;       // by threshold, one a distinct distance, thinned to at most 200
  double recall_at_full_precision = 0;  // largest recall with not one false pair
  double threshold_at_full_precision = 0;
  double average_precision = 0;  // area under the curve
};

Curve precision_recall(std::vector<ScoredPair> pairs);

}  // namespace lxd
