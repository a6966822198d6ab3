// SPDX-License-Identifier: Apache-2.0
// Bytes of a serial line for parsers: from hex, in pieces of any size, and what came out.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "rt/imu_sample.hpp"

namespace lxd::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes bytes_of_hex(std::string_view hex) {
  const auto digit = [](char c) { return static_cast<std::uint8_t>(c <= '9' ? c - '0' : c - 'a' + 10); };
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(digit(hex[i]) << 4U | digit(hex[i + 1])));
  return bytes;
}

inline void append(Bytes& bytes, const Bytes& more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

// All samples that the parser finds in one chunk.
template <typename Parser>
std::vector<ImuSample> samples_of(Parser& parser, std::span<const std::uint8_t> chunk, RigTime received = {}) {
  std::vector<ImuSample> samples;
  ImuSample sample;
  while (!chunk.empty()) {
    chunk = chunk.subspan(parser.feed(chunk, received));
    while (parser.next(sample)) samples.push_back(sample);
  }
  return samples;
}

// The same bytes in pieces of 1 to `longest` bytes.
template <typename Parser>
std::vector<ImuSample> samples_in_pieces(Parser& parser, std::span<const std::uint8_t> bytes, std::size_t longest,
                                         unsigned seed) {
  std::mt19937 random(seed);
  std::vector<ImuSample> samples;
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(1 + random() % longest, bytes.size());
    for (const ImuSample& sample : samples_of(parser, bytes.first(size))) samples.push_back(sample);
    bytes = bytes.subspan(size);
  }
  return samples;
}

// Every byte is accepted, skipped or pending.
template <typename Parser>
bool accounts_for(const Parser& parser, std::size_t bytes) {
  return parser.counts().bytes_accepted + parser.counts().bytes_skipped + parser.bytes_pending() == bytes;
}

}  // namespace lxd::test
