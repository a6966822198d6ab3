// SPDX-License-Identifier: Apache-2.0
// See trigger_matcher.hpp.
#include "drivers/sync/trigger_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

constexpr int kEnough = 8;            // pairs after which the delay is believed
constexpr double kForget = 1.0 / 16;  // weight of a new pair
constexpr double kGateSpreads = 8;    // a delay is of the camera when it is off by at most so many mean deviations
constexpr double kGateMin_s = 1e-3;

}  // namespace

void TriggerMatcher::add_trigger(RigTime edge) {
  if (edge <= newest_) {
    ++counts_.disordered;
    return;
  }
  newest_ = edge;
  if (count_ == kEdges) drop(1);
  edges_[(first_ + count_) % kEdges] = edge;
  ++count_;
}

void TriggerMatcher::drop(std::size_t count) {
  first_ = (first_ + count) % kEdges;
  count_ -= count;
  counts_.triggers_without_frame += count;
}

// Once the delay is known it decides; a lost edge must not make its neighbour's frame of this one.
bool TriggerMatcher::fits(RigTime edge, RigTime frame_stamp) const {
  const Duration delay = frame_stamp - edge;
  if (delay < timing_.delay_min || delay > timing_.delay_max) return false;
  const double gate_s = std::max(kGateMin_s, kGateSpreads * spread_s_);
  return learned_ < kEnough || std::abs(delay.seconds() - delay_s_) <= gate_s;
}

void TriggerMatcher::learn(Duration delay) {
  const double weight = std::max(kForget, 1.0 / (learned_ + 1));
  const double off_s = delay.seconds() - delay_s_;
  if (learned_ > 0) spread_s_ += weight * (std::abs(off_s) - spread_s_);
  delay_s_ += weight * off_s;
  learned_ = std::min(learned_ + 1, kEnough);
}

TriggerMatch TriggerMatcher::refuse(std::uint64_t candidates) {
  ++counts_.frames_without_trigger;
  counts_.ambiguous += candidates > 1 ? 1 : 0;
  return {TriggerVerdict::unmatched, {}};
}

TriggerMatch TriggerMatcher::match(RigTime frame_stamp, RigTime now) {
  std::size_t candidates = 0, last = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!fits(edge(i), frame_stamp)) continue;
    ++candidates;
    last = i;
  }
  const bool may_come = newest_ + timing_.delay_min < frame_stamp && now - frame_stamp < timing_.patience;
  if (candidates == 0 && may_come) return {TriggerVerdict::wait, {}};
  if (candidates != 1) return refuse(candidates);
  const RigTime made = edge(last);
  learn(frame_stamp - made);
  drop(last);
  drop(1);
  --counts_.triggers_without_frame;  // the one that has its frame
  ++counts_.matched;
  return {TriggerVerdict::matched, made + timing_.to_exposure + timing_.exposure / 2};
}

}  // namespace lxd
