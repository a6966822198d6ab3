// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/loop_set.hpp"

#include <algorithm>

namespace lxd {

Matrix6d with_loop_floor(Matrix6d covariance, const GraphConfig& config) {
  covariance.diagonal().head<3>().array() += config.loop_sigma_rad * config.loop_sigma_rad;
  covariance.diagonal().tail<3>().array() += config.loop_sigma_m * config.loop_sigma_m;
  return covariance;
}

bool LoopSet::sound(const LoopMeasurement& loop) {
  const bool finite = loop.T_from_to.p.allFinite() && loop.T_from_to.R.allFinite() && loop.covariance.allFinite() &&
                      (loop.covariance.diagonal().array() >= 0).all();
  counts_.not_finite += !finite;
  const bool known =
      loop.from >= 0 && loop.from < chain_.size() && loop.to >= 0 && loop.to < chain_.size() && loop.from != loop.to;
  counts_.unknown_key_frame += finite && !known;
  return finite && known;
}

bool LoopSet::within_drift(const LoopMeasurement& loop) const {
  return alike({loop.T_from_to, loop.covariance},
               chain_.motion(static_cast<int>(loop.from), static_cast<int>(loop.to)));
}

// From a's older frame by way of b to its younger one.
bool LoopSet::agree(const LoopMeasurement& a, const LoopMeasurement& b) const {
  const auto motion = [this](std::int64_t i, std::int64_t j) {
    return chain_.motion(static_cast<int>(i), static_cast<int>(j));
  };
  const RelativeMotion by_b = motion(a.from, b.from) * RelativeMotion{b.T_from_to, b.covariance} * motion(b.to, a.to);
  return alike({a.T_from_to, a.covariance}, by_b);
}

void LoopSet::retire_oldest() {
  if (agreement_.accepted(0)) settled_.push_back(set_.front());
  counts_.waiting += !agreement_.accepted(0);
  set_.erase(set_.begin());
  agreement_.drop_oldest();
}

bool LoopSet::add(const LoopMeasurement& loop) {
  ++counts_.proposed;
  if (!sound(loop)) return false;
  LoopMeasurement candidate = loop;
  if (loop.from > loop.to) {
    const RelativeMotion turned = inverse_of({loop.T_from_to, loop.covariance});
    candidate = {loop.to, loop.from, turned.T, turned.covariance, loop.by};
  }
  candidate.covariance = with_loop_floor(candidate.covariance, config_);
  if (!within_drift(candidate)) {
    ++counts_.against_drift;
    return false;
  }
  if (agreement_.full()) retire_oldest();
  Agreement::Links agrees;
  for (std::size_t i = 0; i < set_.size(); ++i) agrees[i] = agree(set_[i], candidate);
  set_.push_back(candidate);
  return agreement_.add(agrees);
}

std::vector<LoopMeasurement> LoopSet::accepted() const {
  std::vector<LoopMeasurement> loops = settled_;
  for (std::size_t i = 0; i < set_.size(); ++i)
    if (agreement_.accepted(i)) loops.push_back(set_[i]);
  return loops;
}

LoopCounts LoopSet::counts() const {
  LoopCounts counts = counts_;
  const std::vector<LoopMeasurement> all = accepted();
  counts.accepted = all.size();
  counts.accepted_by_sight = static_cast<std::uint64_t>(
      std::ranges::count_if(all, [](const LoopMeasurement& loop) { return loop.by == LoopSense::sight; }));
  for (std::size_t i = 0; i < set_.size(); ++i) counts.waiting += !agreement_.accepted(i);
  return counts;
}

}  // namespace lxd
