// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/loop_set.hpp"

#include <cmath>

namespace lxd {
namespace {

constexpr double kChiSquare6 = 33.11;  // one true pair in a hundred thousand is beyond it

// Whether the two say the same of one relative pose; their errors are independent.
bool alike(const RelativeMotion& a, const RelativeMotion& b) {
  const Vector6d e = box_minus(a.T, b.T);
  return e.dot((a.covariance + b.covariance).ldlt().solve(e)) < kChiSquare6;
}

}  // namespace

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
  if (set_.front().accepted) settled_.push_back(set_.front().loop);
  counts_.waiting += !set_.front().accepted;
  set_.erase(set_.begin());
  for (Candidate& candidate : set_) candidate.agrees >>= 1;
}

bool LoopSet::add(const LoopMeasurement& loop) {
  ++counts_.proposed;
  if (!sound(loop)) return false;
  Candidate candidate{loop, {}};
  if (loop.from > loop.to) {
    const RelativeMotion turned = inverse_of({loop.T_from_to, loop.covariance});
    candidate.loop = {loop.to, loop.from, turned.T, turned.covariance};
  }
  candidate.loop.covariance.diagonal().head<3>().array() += config_.loop_sigma_rad * config_.loop_sigma_rad;
  candidate.loop.covariance.diagonal().tail<3>().array() += config_.loop_sigma_m * config_.loop_sigma_m;
  if (!within_drift(candidate.loop)) {
    ++counts_.against_drift;
    return false;
  }
  if (set_.size() == kSetMax) retire_oldest();
  for (std::size_t i = 0; i < set_.size(); ++i) {
    candidate.agrees[i] = agree(set_[i].loop, candidate.loop);
    set_[i].agrees[set_.size()] = candidate.agrees[i];
  }
  set_.push_back(candidate);

  const Links clique = largest_clique();
  const bool enough = clique.count() >= static_cast<std::size_t>(config_.loop_agreeing_min);
  bool changed = false;
  for (std::size_t i = 0; i < set_.size(); ++i) {
    const bool accepted = enough && clique[i];
    changed |= accepted != set_[i].accepted;
    set_[i].accepted = accepted;
  }
  return changed;
}

// Greedy: the one that agrees with most of those that are left comes next; of equals the older.
LoopSet::Links LoopSet::clique_with(std::size_t seed) const {
  Links clique, left = set_[seed].agrees;
  clique.set(seed);
  while (left.any()) {
    std::size_t best = kSetMax, most = 0;
    for (std::size_t i = 0; i < set_.size(); ++i) {
      if (!left[i]) continue;
      const std::size_t degree = (set_[i].agrees & left).count();
      if (best != kSetMax && degree <= most) continue;
      best = i;
      most = degree;
    }
    clique.set(best);
    left &= set_[best].agrees;
  }
  return clique;
}

// The seeds are the loop that came last, the one with most friends, and one of those that are accepted now: a full
// search from each would find the same but in odd cases, and take the square of their number.
LoopSet::Links LoopSet::largest_clique() const {
  Links best = clique_with(set_.size() - 1);
  std::size_t popular = 0, standing = set_.size() - 1;
  for (std::size_t i = 0; i < set_.size(); ++i) {
    if (set_[i].agrees.count() > set_[popular].agrees.count()) popular = i;
    if (set_[i].accepted) standing = i;
  }
  for (const std::size_t seed : {popular, standing}) {
    const Links clique = clique_with(seed);
    if (clique.count() > best.count()) best = clique;
  }
  return best;
}

std::vector<LoopMeasurement> LoopSet::accepted() const {
  std::vector<LoopMeasurement> loops = settled_;
  for (const Candidate& candidate : set_)
    if (candidate.accepted) loops.push_back(candidate.loop);
  return loops;
}

LoopCounts LoopSet::counts() const {
  LoopCounts counts = counts_;
  counts.accepted = settled_.size();
  for (const Candidate& candidate : set_) ++(candidate.accepted ? counts.accepted : counts.waiting);
  return counts;
}

}  // namespace lxd
