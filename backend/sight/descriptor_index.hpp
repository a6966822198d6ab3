// SPDX-License-Identifier: Apache-2.0
// Which key frames show what an image shows: a multi-index hash over binary descriptors. Features whose descriptors are
// equal in one of several runs of bits vote for each other's key frames. Nothing is trained; memory and the work of a
// question are bounded.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "backend/pnp/visual_key_frame.hpp"

namespace lxd {

class DescriptorIndex {
 public:
  static constexpr std::size_t kTables = 8;  // the first 128 bits: those of ORB's pairs that tell most
  static constexpr std::size_t kLooks = 32;  // entries of a run's value that are looked at, newest first
  static constexpr std::size_t kEntryBytes = 2 * sizeof(std::uint32_t);
  static constexpr std::size_t kHeadBytes = kTables * 65'536 * sizeof(std::uint32_t);

  // features_max: that there is room for; more take more.
  explicit DescriptorIndex(std::size_t features_max = 0) : entries_max_(kTables * features_max) {}

  // `frame` counts up from zero; a key frame is added once.
  void add(std::uint32_t frame, std::span<const VisualFeature> features);
  void clear();

  // By key frame, as many as `frames`: votes, each worth one over those that a feature gives in one table, so that what
  // is seen everywhere tells little.
  [[nodiscard]] std::vector<float> votes(std::span<const VisualFeature> features, std::size_t frames) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Entry {
    std::uint32_t next, frame;
  };

  std::size_t entries_max_;
  std::vector<std::uint32_t> heads_;  // by table and value; empty until there is an entry
  std::vector<Entry> entries_;        // lists through them, newest first
};

}  // namespace lxd
