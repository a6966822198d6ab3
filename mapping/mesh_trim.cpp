// SPDX-License-Identifier: Apache-2.0
#include "mapping/mesh_trim.hpp"

#include <algorithm>

namespace lxd {

// One of two directed edges has a face.
bool MeshTrim::is_open(std::uint32_t a, std::uint32_t b) const {
  return (topology_.face_of_edge(a, b) == kNone) != (topology_.face_of_edge(b, a) == kNone);
}

void MeshTrim::pull(std::uint32_t vertex, std::uint32_t inner, float share, std::uint32_t direction) {
  if (count_ < storage_.size())
    storage_[count_++] = {std::uint64_t{2} * vertex + direction, share, inner};
  else
    ++no_room_;
}

void MeshTrim::add(const std::array<std::uint32_t, 4>& corners, const std::array<float, 4>& overhang) {
  for (std::uint32_t side = 0; side < 4; ++side) {
    const std::uint32_t a = corners[side], b = corners[(side + 1) % 4];
    if (!is_open(a, b)) continue;
    pull(a, corners[(side + 3) % 4], overhang[side], side % 2);
    pull(b, corners[(side + 2) % 4], overhang[side], side % 2);
  }
}

std::uint64_t MeshTrim::apply() {
  const auto pulls = storage_.first(count_);
  std::sort(pulls.begin(), pulls.end());
  for (std::size_t begin = 0; begin < pulls.size();) {
    const std::uint64_t key = pulls[begin].key;
    Eigen::Vector3f& position_m = topology_.vertex(static_cast<std::uint32_t>(key / 2)).position_m;
    Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
    std::size_t end = begin;
    for (; end < pulls.size() && pulls[end].key == key; ++end)
      sum_m += pulls[end].order * (topology_.vertex(pulls[end].slot).position_m - position_m);
    position_m += sum_m / static_cast<float>(end - begin);
    begin = end;
  }
  return no_room_;
}

}  // namespace lxd
