// SPDX-License-Identifier: Apache-2.0
// An assembled frame becomes a Sweep: points in the sensor's frame, times from the columns' own stamps. Of a profile
// with two returns both are points: all first ones (the strongest of their pixels), column after column, then all
// second ones. So where the sweep has no room for all it is second returns that are left out.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/ouster/frame_assembler.hpp"
#include "drivers/ouster/xyz_table.hpp"
#include "rt/sweep.hpp"

namespace lxd {

struct OusterSweepCounts {
  std::uint64_t no_return = 0;        // pixels whose first range is zero
  std::uint64_t second_returns = 0;   // points
  std::uint64_t above_capacity = 0;   // points
  std::uint64_t bad_column_time = 0;  // columns
};

class OusterSweepBuilder {
 public:
  explicit OusterSweepBuilder(const OusterMetadata& metadata);

  // Fills begin, end, stamp (the end), count and points, on the sensor's clock. False: not one point.
  // Allocates nothing.
  bool build(const OusterFrame& frame, Sweep& sweep);
  [[nodiscard]] const OusterSweepCounts& counts() const { return counts_; }

 private:
  struct TimeSpan {
    std::int64_t first_ns = 0, last_ns = 0;
  };
  [[nodiscard]] std::int64_t median_time_ns(const OusterFrame& frame);
  [[nodiscard]] bool sound_time(const OusterFrame& frame, std::size_t column) const;
  [[nodiscard]] TimeSpan sound_span(const OusterFrame& frame);
  // One return of all columns.
  struct Returns {
    const std::vector<std::uint32_t>& range_mm;
    const std::vector<std::uint16_t>& reflectivity;
    std::uint64_t& none;
  };
  void add_returns(const OusterFrame& frame, const Returns& returns, std::int64_t begin_ns, Sweep& sweep);
  void add_column(const Returns& returns, std::size_t column, std::uint32_t offset_ns, Sweep& sweep);

  OusterXyzTable table_;
  std::size_t rows_;
  std::vector<std::int64_t> times_;  // scratch for the median
  std::int64_t median_ns_ = 0;
  OusterSweepCounts counts_;
};

}  // namespace lxd
