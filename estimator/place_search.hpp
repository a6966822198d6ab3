// SPDX-License-Identifier: Apache-2.0
// Where a body is of which only a vague prediction is known: the place round about that fits best. What is asked for a
// fit has a peak at the true place, among cars half a metre wide, with lesser ones beside it: the nodes of the grid are
// so near to each other that none lies between them, and a descent from the best few finds the top.
//
// The grid and the first, wide steps ask for a coarse fit, the last, narrow ones from the best few for a fine one. So
// the work is bounded by constants, kCoarseFitsMax and kFineFitsMax for each search, and does not depend on the clock.
// No storage.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

// How much work a fit may cost: a coarse one compares places a decimetre apart, a fine one centimetres.
enum class FitDetail : std::uint8_t { coarse, fine };

inline constexpr double kSearchRadiusMax_m = 6;
inline constexpr std::size_t kSearchYawsMax = 2;

namespace place_search {

inline constexpr double kGridStep_m = 0.5;           // at one yaw
inline constexpr double kTwoYawsGridStep_m = 0.725;  // so that it has no more nodes
inline constexpr int kGridNodes = 442;               // within 6 m, of all yaws
inline constexpr std::size_t kStarts = 6;            // nodes of the grid that a descent begins at
inline constexpr std::size_t kFinishers = 2;         // of them, the best that are finished with fine fits
inline constexpr double kNodesApart_m = 0.75;        // nearer, two nodes lead to one peak
inline constexpr double kApart_m = 0.5;              // nearer, two places are one peak
inline constexpr double kYawsApart_rad = 0.12;       // likewise
inline constexpr double kFirstStep_m = 0.25, kFirstStep_rad = 0.06;
inline constexpr int kCoarseLevels = 1, kLevels = 3;          // steps are halved so often
inline constexpr int kCoarseMovesMax = 2, kFineMovesMax = 4;  // with each
inline constexpr int kNeighbours = 6;

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

// Likewise, but of those that have come to the same peak only the best.
inline void keep_apart(const FoundPlace& place, double apart_m, std::span<FoundPlace> best) {
  for (FoundPlace& kept : best) {
    const double x_m = place.offset.x_m - kept.offset.x_m, y_m = place.offset.y_m - kept.offset.y_m;
    const bool same = x_m * x_m + y_m * y_m < apart_m * apart_m &&
                      std::abs(place.offset.yaw_rad - kept.offset.yaw_rad) < kYawsApart_rad;
    if (!same || !(kept.fit > 0)) continue;
    kept = place.fit > kept.fit ? place : kept;
    std::sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.fit > b.fit; });
    return;
  }
  keep(place, best);
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

// From level `begin` of the steps up to `end`; place.fit is of the same detail as fit().
template <typename Fit>
FoundPlace climb(FoundPlace place, int begin, int end, int moves_max, Fit&& fit) {
  for (int level = begin; level < end; ++level)
    for (int move = 0; move < moves_max; ++move) {
      const FoundPlace next = best_neighbour(place, std::ldexp(1.0, -level), fit);
      if (!(next.fit > place.fit)) break;
      place = next;
    }
  return place;
}

inline std::span<const double> distinct(std::span<const double> yaws_rad) {
  const bool both = yaws_rad.size() > 1 && std::abs(yaws_rad[1] - yaws_rad[0]) > kFirstStep_rad;
  return yaws_rad.first(std::min<std::size_t>(yaws_rad.size(), both ? kSearchYawsMax : 1));
}

}  // namespace place_search

// Fits that one search asks for, at most.
inline constexpr int kCoarseFitsMax =
    place_search::kGridNodes + static_cast<int>(place_search::kStarts) * place_search::kCoarseLevels *
                                   place_search::kCoarseMovesMax * place_search::kNeighbours;
inline constexpr int kFineFitsMax =
    static_cast<int>(place_search::kFinishers) * (1 + (place_search::kLevels - place_search::kCoarseLevels) *
                                                          place_search::kFineMovesMax * place_search::kNeighbours);

// Within radius_m of the prediction (kSearchRadiusMax_m at most), from each of the yaws (kSearchYawsMax are looked at,
// and of two that are near to each other the first).
// fit: of a PlaceOffset in a FitDetail, > 0; the place found has a fine one.
template <typename Fit>
FoundPlace seek_place(double radius_m, std::span<const double> yaws_rad, Fit&& fit) {
  const auto coarse = [&](const PlaceOffset& at) { return fit(at, FitDetail::coarse); };
  const auto fine = [&](const PlaceOffset& at) { return fit(at, FitDetail::fine); };
  const std::span<const double> yaws = place_search::distinct(yaws_rad);
  std::array<FoundPlace, place_search::kStarts> starts{};
  const double radius = std::min(radius_m, kSearchRadiusMax_m);
  const double step_m = yaws.size() > 1 ? place_search::kTwoYawsGridStep_m : place_search::kGridStep_m;
  const int steps = static_cast<int>(std::ceil(radius / step_m));
  for (const double yaw : yaws)
    for (int x = -steps; x <= steps; ++x)
      for (int y = -steps; y <= steps; ++y) {
        const PlaceOffset at{x * step_m, y * step_m, yaw};
        if (at.x_m * at.x_m + at.y_m * at.y_m <= radius * radius)
          place_search::keep_apart({at, coarse(at)}, place_search::kNodesApart_m, starts);
      }
  std::array<FoundPlace, place_search::kFinishers> finishers{};
  for (const FoundPlace& start : starts)
    place_search::keep_apart(
        place_search::climb(start, 0, place_search::kCoarseLevels, place_search::kCoarseMovesMax, coarse),
        place_search::kApart_m, finishers);
  FoundPlace best;
  for (const FoundPlace& finisher : finishers) {
    const FoundPlace begin{finisher.offset, fine(finisher.offset)};
    const FoundPlace found = place_search::climb(begin, place_search::kCoarseLevels, place_search::kLevels,
                                                 place_search::kFineMovesMax, fine);
    if (found.fit > best.fit) best = found;
  }
  return best;
}

}  // namespace lxd
