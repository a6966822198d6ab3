// SPDX-License-Identifier: Apache-2.0
// Which trigger of the sync microcontroller made which frame. The trigger's edge is stamped to microseconds; the
// camera's own stamp comes later by exposure, read-out and driver, which the matcher learns. Frames then get the edge's
// time instead of their own. Fixed memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rt/time.hpp"

namespace lxd {

struct TriggerTiming {
  // From the edge to the frame's stamp. While less than the triggers' period lies between the two, the first frame is
  // matched already; otherwise frames stay unmatched until one has a single edge to choose.
  Duration delay_min = Duration::from_ns(0);
  Duration delay_max = Duration::from_ns(60'000'000);
  Duration to_exposure;  // from the edge until the exposure begins
  Duration exposure;     // an image is of the exposure's middle
  // Edges and frames come by different ways: how long a frame waits for its edge.
  Duration patience = Duration::from_ns(100'000'000);
};

struct TriggerCounts {
  std::uint64_t matched = 0;
  std::uint64_t frames_without_trigger = 0;  // an edge was lost, or the camera runs freely
  std::uint64_t ambiguous = 0;               // of those: several edges would do
  std::uint64_t triggers_without_frame = 0;
  std::uint64_t disordered = 0;  // edges not later than the one before: left out
};

enum class TriggerVerdict : std::uint8_t {
  matched,
  wait,      // its edge may still come: ask again
  unmatched  // counted; the frame has its own stamp only
};

struct TriggerMatch {
  TriggerVerdict verdict = TriggerVerdict::unmatched;
  RigTime instant;  // of the exposure's middle, when matched
};

class TriggerMatcher {
 public:
  explicit TriggerMatcher(const TriggerTiming& timing) : timing_(timing) {}

  void add_trigger(RigTime edge);
  // Frames in their order, each until the answer is not `wait`.
  TriggerMatch match(RigTime frame_stamp, RigTime now);

  [[nodiscard]] const TriggerCounts& counts() const { return counts_; }
  // From edge to frame stamp, as learned.
  [[nodiscard]] Duration delay() const { return Duration::from_seconds(delay_s_); }

 private:
  static constexpr std::size_t kEdges = 64;  // more than any camera is behind

  [[nodiscard]] RigTime edge(std::size_t i) const { return edges_[(first_ + i) % kEdges]; }
  [[nodiscard]] bool fits(RigTime edge, RigTime frame_stamp) const;
  void drop(std::size_t count);
  void learn(Duration delay);
  TriggerMatch refuse(std::uint64_t candidates);

  TriggerTiming timing_;
  std::array<RigTime, kEdges> edges_{};  // a ring, in order; not matched yet
  std::size_t first_ = 0, count_ = 0;
  RigTime newest_ = kNever;
  int learned_ = 0;  // pairs that the delay rests upon, up to enough
  double delay_s_ = 0, spread_s_ = 0;
  TriggerCounts counts_;
};

}  // namespace lxd
