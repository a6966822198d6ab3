// SPDX-License-Identifier: Apache-2.0
// What every recorded LiDAR source looks like to the board: a stream of sweeps, pulled one by one.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rt/result.hpp"
#include "rt/sweep.hpp"

namespace lxd {

// What a source knows of its primary LiDAR without a rig file; zero: not known.
struct LidarTraits {
  std::uint32_t beams = 0;
  std::uint32_t columns = 0;
  double rate_hz = 0;
};

class SweepSource {
 public:
  virtual ~SweepSource() = default;

  // Fills `sweep` (begin, end, stamp, sequence, points; storage is the caller's).
  // True: a sweep was read. False: the recording has ended. A damaged sweep is counted in rejected() and passed over,
  // or read as far as it is sound; an Error means that nothing more can be read.
  virtual Result<bool> next(Sweep& sweep) = 0;

  // Number of sweeps in the whole recording where it can be known beforehand.
  [[nodiscard]] virtual std::optional<std::uint64_t> size() const = 0;
  [[nodiscard]] virtual std::string kind() const = 0;  // as the README's table names it
  [[nodiscard]] virtual LidarTraits traits() const = 0;
  // Rejections since the start by cause, e.g. {"truncated_file": 1, "non_finite_point": 17, "above_capacity": 3}.
  [[nodiscard]] virtual const std::map<std::string, std::uint64_t>& rejected() const = 0;
  // Sentences for the user on what the recording lacks and what was assumed instead. Known once the source is open.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};

}  // namespace lxd
