// SPDX-License-Identifier: Apache-2.0
// The largest set of statements in which each agrees with every other (pairwise consistency maximisation: Mangelson,
// Dominic, Eustice, Vasudevan, ICRA 2018), searched greedily. Statements are known by their order; work and memory for
// each are bounded.
#pragma once

#include <bitset>
#include <cstddef>
#include <vector>

namespace lxd {

class Agreement {
 public:
  static constexpr std::size_t kMax = 256;  // statements that are compared with each other
  using Links = std::bitset<kMax>;

  // `enough`: fewer than so many that agree are none.
  explicit Agreement(std::size_t enough) : enough_(enough) {}

  [[nodiscard]] std::size_t size() const { return links_.size(); }
  [[nodiscard]] bool full() const { return size() == kMax; }
  [[nodiscard]] bool accepted(std::size_t i) const { return accepted_[i]; }

  // The next one, and which of those that are there it agrees with. True: the accepted ones are others than before.
  bool add(const Links& agrees);
  // The others count on from 0.
  void drop_oldest();

 private:
  [[nodiscard]] Links clique_with(std::size_t seed) const;
  [[nodiscard]] Links largest_clique() const;

  std::size_t enough_;
  std::vector<Links> links_;  // of each
  Links accepted_;
};

}  // namespace lxd
