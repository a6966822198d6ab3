// SPDX-License-Identifier: Apache-2.0
#include "backend/sight/descriptor_index.hpp"

#include <algorithm>
#include <array>

namespace lxd {
namespace {

constexpr std::size_t kValues = 65'536;  // of 16 bits

// Where the list of a descriptor's run of bits begins.
std::size_t head_of(const OrbDescriptor& d, std::size_t table) {
  return table * kValues + static_cast<std::size_t>(d[2 * table] | (d[2 * table + 1] << 8U));
}

}  // namespace

void DescriptorIndex::add(std::uint32_t frame, std::span<const VisualFeature> features) {
  if (heads_.empty()) heads_.assign(kTables * kValues, kNone);
  entries_.reserve(std::max(entries_max_, entries_.size() + kTables * features.size()));
  for (const VisualFeature& feature : features) {
    for (std::size_t table = 0; table < kTables; ++table) {
      std::uint32_t& head = heads_[head_of(feature.descriptor, table)];
      entries_.push_back({head, frame});
      head = static_cast<std::uint32_t>(entries_.size() - 1);
    }
  }
}

void DescriptorIndex::clear() {
  heads_.clear();
  entries_.clear();
}

std::vector<float> DescriptorIndex::votes(std::span<const VisualFeature> features, std::size_t frames) const {
  std::vector<float> out(frames, 0.0F);
  if (heads_.empty()) return out;
  std::array<std::uint32_t, kLooks> met{};
  for (const VisualFeature& feature : features) {
    for (std::size_t table = 0; table < kTables; ++table) {
      std::size_t count = 0;
      for (std::uint32_t i = heads_[head_of(feature.descriptor, table)]; i != kNone && count < kLooks;
           i = entries_[i].next)
        met[count++] = entries_[i].frame;
      for (const std::uint32_t frame : std::span(met).first(count)) out[frame] += 1.0F / static_cast<float>(count);
    }
  }
  return out;
}

std::size_t DescriptorIndex::bytes() const {
  return heads_.size() * sizeof(std::uint32_t) + entries_.size() * sizeof(Entry);
}

}  // namespace lxd
