// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/agreement.hpp"

namespace lxd {

bool Agreement::add(const Links& agrees) {
  const std::size_t added = links_.size();
  for (std::size_t i = 0; i < added; ++i) links_[i][added] = agrees[i];
  links_.push_back(agrees);
  Links clique = largest_clique();
  if (clique.count() < enough_) clique.reset();
  const bool changed = clique != accepted_;
  accepted_ = clique;
  return changed;
}

void Agreement::drop_oldest() {
  links_.erase(links_.begin());
  for (Links& links : links_) links >>= 1;
  accepted_ >>= 1;
}

// Greedy: the one that agrees with most of those that are left comes next; of equals the older.
Agreement::Links Agreement::clique_with(std::size_t seed) const {
  Links clique, left = links_[seed];
  clique.set(seed);
  while (left.any()) {
    std::size_t best = kMax, most = 0;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      if (!left[i]) continue;
      const std::size_t degree = (links_[i] & left).count();
      if (best != kMax && degree <= most) continue;
      best = i;
      most = degree;
    }
    clique.set(best);
    left &= links_[best];
  }
  return clique;
}

// The seeds are the one that came last, the one with most friends, and one of those that are accepted now: a full
// search from each would find the same but in odd cases, and take the square of their number.
Agreement::Links Agreement::largest_clique() const {
  Links best = clique_with(links_.size() - 1);
  std::size_t popular = 0, standing = links_.size() - 1;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].count() > links_[popular].count()) popular = i;
    if (accepted_[i]) standing = i;
  }
  for (const std::size_t seed : {popular, standing}) {
    const Links clique = clique_with(seed);
    if (clique.count() > best.count()) best = clique;
  }
  return best;
}

}  // namespace lxd
