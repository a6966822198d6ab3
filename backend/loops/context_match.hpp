// SPDX-License-Identifier: Apache-2.0
// How alike two places are by their Extended Scan Contexts, over all headings, where both have been seen.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "backend/loops/scan_context.hpp"

namespace lxd {

struct ContextMatchConfig {
  double common_min = 0.6;      // share of either place's structure that the other must have seen
  double unseen_weight = 0.5;   // of the share that it has not, as a distance
  double density_weight = 0.5;  // of the channels in a column's likeness; height and visibility weigh one
};

struct ContextMatch {
  double distance = 1;  // 0: the same; 1: nothing alike, or too little that both have seen
  int shift = 0;        // sectors: the candidate's sector i + shift shows what the query's sector i does

  // Of R_candidate_query: by how much the query's axes are turned in the candidate's; -pi .. pi.
  [[nodiscard]] double yaw_rad() const;
};

// One place made ready to be compared with many.
class ContextMatcher {
 public:
  explicit ContextMatcher(const ContextMatchConfig& config) : config_(config) {}
  void set_query(const ScanContext& query) { unpack(query, query_); }
  ContextMatch match(const ScanContext& candidate);

 private:
  // A channel under its mask: values x, their squares, both zero where the bin is unknown. Sectors along the columns,
  // twice, so that turning the place is an offset.
  using Plane = Eigen::Array<float, 2 * kContextSectors, kContextRings>;
  using Sectors = Eigen::Array<float, kContextSectors, 1>;
  struct Channel {
    Plane value, square;
  };
  struct Unpacked {
    Plane seen;
    Channel height, density, structure;
    float structure_bins = 0;
  };
  struct Products {
    Sectors cross, query, candidate;  // sums over a sector's bins that both have seen
  };

  static void unpack(const ScanContext& context, Unpacked& out);
  static Products multiply(const Unpacked& q, const Unpacked& c, const Channel& in_q, const Channel& in_c, int shift);
  [[nodiscard]] double distance_at(int shift) const;

  ContextMatchConfig config_;
  Unpacked query_, candidate_;
};

}  // namespace lxd
