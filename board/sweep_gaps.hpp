// SPDX-License-Identifier: Apache-2.0
// While the primary LiDAR is silent its sweeps are missing, one after the other. Here they are told from the rhythm of
// those that came: the other sensors carry the pose on to the times that each would have had.
#pragma once

#include <optional>

#include "rt/sweep.hpp"
#include "rt/time.hpp"

namespace lxd {

class SweepGaps {
 public:
  // The next one, without returns, if it is missing when nothing came before one that begins at `begin`.
  [[nodiscard]] std::optional<Sweep> missing(RigTime begin) const;
  // The next one, if none comes any more.
  [[nodiscard]] std::optional<Sweep> next() const;

  // A sweep that came; two of them make a rhythm.
  void came(const Sweep& sweep);
  // One that was told and taken.
  void carried(const Sweep& missing);
  // Nothing carries the pose: none is missing until the next one comes.
  void give_up() { last_.reset(); }
  // The stamps begin again.
  void restart() { *this = {}; }

 private:
  std::optional<Sweep> last_;  // its times only
  bool last_came_ = false;
  std::optional<Duration> period_;
};

}  // namespace lxd
