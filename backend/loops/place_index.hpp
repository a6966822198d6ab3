// SPDX-License-Identifier: Apache-2.0
// The places that look alike by their ring keys, found without asking all of them: k-d trees of doubling size, so that
// adding a place costs little on average and a query stays logarithmic. The same additions give the same answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "backend/loops/scan_context.hpp"

namespace lxd {

struct NearPlace {
  float distance2_m2;  // of the ring keys
  std::uint32_t place;
};

struct NearestQuery {
  RingKey key;
  std::size_t count = 1;                       // places wanted
  std::size_t visits_max = 512;                // keys that each tree looks at: with many alike the answer is
                                               // approximate, the work is not
  std::function<bool(std::uint32_t)> allowed;  // of a place
};

class PlaceIndex {
 public:
  void add(const RingKey& key, std::uint32_t place);
  [[nodiscard]] std::size_t size() const;
  // Nearest first; of equally near ones the newest (largest number) first.
  [[nodiscard]] std::vector<NearPlace> nearest(const NearestQuery& query) const;

 private:
  struct Entry {
    RingKey key;
    std::uint32_t place;
  };
  // Balanced and implicit: the middle entry of a range splits it along the dimension `split`.
  struct Tree {
    std::vector<Entry> entries;
    std::vector<std::uint8_t> split;
  };
  class Search;

  static void build(Tree& tree, std::size_t begin, std::size_t end);

  static constexpr std::size_t kNewest = 32;  // places that are not in a tree yet
  std::vector<Entry> newest_;
  std::vector<Tree> trees_;  // the i-th has kNewest * 2^i entries, or none
};

}  // namespace lxd
