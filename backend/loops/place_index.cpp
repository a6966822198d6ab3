// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/place_index.hpp"

#include <algorithm>
#include <utility>

namespace lxd {
namespace {

float distance2(const RingKey& a, const RingKey& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

bool nearer(const NearPlace& a, const NearPlace& b) {
  return a.distance2_m2 != b.distance2_m2 ? a.distance2_m2 < b.distance2_m2 : a.place > b.place;
}

}  // namespace

// Keeps the best found so far, worst on top.
class PlaceIndex::Search {
 public:
  explicit Search(const NearestQuery& query) : query_(&query) {}

  void try_entry(const Entry& entry) {
    const NearPlace found{distance2(query_->key, entry.key), entry.place};
    if (best_.size() == query_->count && !nearer(found, best_.front())) return;
    if (query_->allowed && !query_->allowed(entry.place)) return;
    if (best_.size() == query_->count) {
      std::pop_heap(best_.begin(), best_.end(), nearer);
      best_.pop_back();
    }
    best_.push_back(found);
    std::push_heap(best_.begin(), best_.end(), nearer);
  }

  void walk(const Tree& tree) {
    visits_ = query_->visits_max;
    walk(tree, 0, tree.entries.size());
  }

  std::vector<NearPlace> take() {
    std::sort(best_.begin(), best_.end(), nearer);
    return std::move(best_);
  }

 private:
  void walk(const Tree& tree, std::size_t begin, std::size_t end) {
    if (begin == end || visits_ == 0) return;
    --visits_;
    const std::size_t middle = begin + (end - begin) / 2;
    try_entry(tree.entries[middle]);
    const std::size_t d = tree.split[middle];
    const float offset = query_->key[d] - tree.entries[middle].key[d];
    const std::pair left{begin, middle}, right{middle + 1, end};
    const auto& near = offset < 0 ? left : right;
    const auto& far = offset < 0 ? right : left;
    walk(tree, near.first, near.second);
    if (best_.size() < query_->count || offset * offset <= best_.front().distance2_m2)
      walk(tree, far.first, far.second);
  }

  const NearestQuery* query_;
  std::vector<NearPlace> best_;
  std::size_t visits_ = 0;
};

// Splits along the dimension of the widest spread.
void PlaceIndex::build(Tree& tree, std::size_t begin, std::size_t end) {
  if (begin == end) return;
  RingKey low = tree.entries[begin].key, high = low;
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t d = 0; d < low.size(); ++d) {
      low[d] = std::min(low[d], tree.entries[i].key[d]);
      high[d] = std::max(high[d], tree.entries[i].key[d]);
    }
  }
  std::size_t widest = 0;
  for (std::size_t d = 1; d < low.size(); ++d)
    if (high[d] - low[d] > high[widest] - low[widest]) widest = d;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return tree.entries.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [widest](const Entry& a, const Entry& b) {
    return a.key[widest] != b.key[widest] ? a.key[widest] < b.key[widest] : a.place < b.place;
  });
  tree.split[middle] = static_cast<std::uint8_t>(widest);
  build(tree, begin, middle);
  build(tree, middle + 1, end);
}

void PlaceIndex::add(const RingKey& key, std::uint32_t place) {
  newest_.push_back({key, place});
  if (newest_.size() < kNewest) return;
  Tree carried{std::move(newest_), {}};
  newest_.clear();
  std::size_t level = 0;
  for (; level < trees_.size() && !trees_[level].entries.empty(); ++level) {
    std::vector<Entry>& taken = trees_[level].entries;
    carried.entries.insert(carried.entries.end(), taken.begin(), taken.end());
    trees_[level] = {};
  }
  carried.split.resize(carried.entries.size());
  build(carried, 0, carried.entries.size());
  if (level == trees_.size()) trees_.emplace_back();
  trees_[level] = std::move(carried);
}

std::size_t PlaceIndex::size() const {
  std::size_t count = newest_.size();
  for (const Tree& tree : trees_) count += tree.entries.size();
  return count;
}

std::vector<NearPlace> PlaceIndex::nearest(const NearestQuery& query) const {
  if (query.count == 0) return {};
  Search search(query);
  for (const Entry& entry : newest_) search.try_entry(entry);
  for (const Tree& tree : trees_) search.walk(tree);
  return search.take();
}

}  // namespace lxd
