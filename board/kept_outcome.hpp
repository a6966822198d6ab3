// SPDX-License-Identifier: Apache-2.0
// A sweep's outcome and the filter's view of it with copies of what their spans show: it outlives the next sweep.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "board/map_keeper.hpp"
#include "estimator/sweep_outcome.hpp"

namespace lxd {

class KeptOutcome {
 public:
  // points: registered ones, at most. All storage there will ever be.
  explicit KeptOutcome(std::size_t points) : points_(points) {}
  KeptOutcome(KeptOutcome&&) = default;  // its vector's storage stays; see keep()
  KeptOutcome(const KeptOutcome&) = delete;
  KeptOutcome& operator=(const KeptOutcome&) = delete;

  // What there is no room for is left out. Not to be moved any more.
  void keep(const SweepOutcome& outcome, const FilterView& view) noexcept {
    outcome_ = outcome;
    view_ = view;
    const std::size_t count = std::min(outcome.registered.size(), points_.size());
    std::copy_n(outcome.registered.begin(), count, points_.begin());
    outcome_.registered = std::span(points_).first(count);
    const std::size_t features = std::min(view.sighted.features.size(), features_.size());
    std::copy_n(view.sighted.features.begin(), features, features_.begin());
    view_.sighted.features = std::span(features_).first(features);
  }

  [[nodiscard]] const SweepOutcome& outcome() const { return outcome_; }
  [[nodiscard]] const FilterView& view() const { return view_; }

 private:
  SweepOutcome outcome_;
  FilterView view_;
  std::vector<RegisteredPoint> points_;
  std::array<SightedFeature, kFeaturesMax> features_;
};

}  // namespace lxd
