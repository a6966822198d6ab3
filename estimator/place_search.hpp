// SPDX-License-Identifier: Apache-2.0
// Where a body is of which only a vague prediction is known: the place round about that fits best. What is asked for a
// fit has a narrow peak at the true place and slopes towards it from metres away, with lesser peaks beside it, so that
// a coarse grid finds the slopes and a descent from the best of its nodes finds the peak.
//
// Work is bounded by constants; no storage.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace lxd {

// Off the prediction: along two axes, and turned about the third.
struct PlaceOffset {
  double x_m = 0, y_m = 0, yaw_rad = 0;
};

struct FoundPlace {
  PlaceOffset offset;
  double fit = 0;
};

inline constexpr double kSearchRadiusMax_m = 6;

namespace place_search {

inline constexpr double kGridStep_m = 1;
inline constexpr std::size_t kStarts = 6;  // nodes of the grid that a descent begins at
inline constexpr double kFirstStep_m = 0.5, kFirstStep_rad = 0.06;
inline constexpr int kLevels = 4, kMovesMax = 4;  // steps are halved so often; moves with each

// Keeps the best, in descending order.
inline void keep(const FoundPlace& place, std::span<FoundPlace> best) {
  for (FoundPlace& kept : best)
    if (place.fit > kept.fit) {
      const auto from = static_cast<std::ptrdiff_t>(&kept - best.data());
      std::copy_backward(best.begin() + from, best.end() - 1, best.end());
      kept = place;
      return;
    }
}

template <typename Fit>
FoundPlace best_neighbour(const FoundPlace& place, double scale, Fit&& fit) {
  FoundPlace best = place;
  for (const double sign : {-scale, scale})
    for (const PlaceOffset& step :
         {PlaceOffset{kFirstStep_m, 0, 0}, PlaceOffset{0, kFirstStep_m, 0}, PlaceOffset{0, 0, kFirstStep_rad}}) {
      const PlaceOffset& at = place.offset;
      const PlaceOffset to{at.x_m + sign * step.x_m, at.y_m + sign * step.y_m, at.yaw_rad + sign * step.yaw_rad};
      const double there = fit(to);
      if (there > best.fit) best = {to, there};
    }
  return best;
}

template <typename Fit>
FoundPlace climb(FoundPlace place, Fit&& fit) {
  double scale = 1;
  for (int level = 0; level < kLevels; ++level, scale /= 2)
    for (int move = 0; move < kMovesMax; ++move) {
      const FoundPlace next = best_neighbour(place, scale, fit);
      if (!(next.fit > place.fit)) break;
      place = next;
    }
  return place;
}

}  // namespace place_search

// Within radius_m of the prediction (kSearchRadiusMax_m at most), from each of the yaws. fit: of a PlaceOffset, > 0.
template <typename Fit>
FoundPlace seek_place(double radius_m, std::span<const double> yaws_rad, Fit&& fit) {
  std::array<FoundPlace, place_search::kStarts> starts{};
  const double radius = std::min(radius_m, kSearchRadiusMax_m);
  const int steps = static_cast<int>(std::ceil(radius / place_search::kGridStep_m));
  for (const double yaw : yaws_rad)
    for (int x = -steps; x <= steps; ++x)
      for (int y = -steps; y <= steps; ++y) {
        const PlaceOffset at{x * place_search::kGridStep_m, y * place_search::kGridStep_m, yaw};
        if (at.x_m * at.x_m + at.y_m * at.y_m <= radius * radius) place_search::keep({at, fit(at)}, starts);
      }
  FoundPlace best;
  for (const FoundPlace& start : starts)
    if (const FoundPlace found = place_search::climb(start, fit); found.fit > best.fit) best = found;
  return best;
}

}  // namespace lxd
