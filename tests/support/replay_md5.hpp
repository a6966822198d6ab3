// SPDX-License-Identifier: Apache-2.0
// MD5 (RFC 1321), for comparing with the digests that ouster-sdk keeps of its captures. Not for security.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

namespace lxd::replay_test {

class Md5 {
 public:
  void update(std::span<const std::uint8_t> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

  std::string hex() {
    const std::uint64_t bits = bytes_.size() * 8;
    bytes_.push_back(0x80);
    while (bytes_.size() % 64 != 56) bytes_.push_back(0);
    for (unsigned i = 0; i < 8; ++i) bytes_.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
    for (std::size_t at = 0; at < bytes_.size(); at += 64) block(&bytes_[at]);
    std::string text;
    for (const std::uint32_t word : state_) {
      for (unsigned i = 0; i < 4; ++i) {
        std::array<char, 3> two{};
        std::snprintf(two.data(), two.size(), "%02x", word >> (8 * i) & 0xFFU);
        text += two.data();
      }
    }
    return text;
  }

 private:
  void block(const std::uint8_t* bytes) {
    static constexpr std::array<std::array<int, 4>, 4> kShifts{
        {{7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}}};
    std::array<std::uint32_t, 16> words{};
    for (unsigned i = 0; i < 64; ++i) words[i / 4] |= std::uint32_t{bytes[i]} << (8 * (i % 4));
    auto [a, b, c, d] = state_;
    for (unsigned i = 0; i < 64; ++i) {
      const std::array<std::uint32_t, 4> mixes{(b & c) | (~b & d), (d & b) | (~d & c), b ^ c ^ d, c ^ (b | ~d)};
      const std::array<unsigned, 4> picks{i, 5 * i + 1, 3 * i + 5, 7 * i};
      const auto sine = static_cast<std::uint32_t>(std::floor(std::abs(std::sin(i + 1.0)) * 4294967296.0));
      const std::uint32_t sum = a + mixes[i / 16] + sine + words[picks[i / 16] % 16];
      a = d;
      d = c;
      c = b;
      b += std::rotl(sum, kShifts[i / 16][i % 4]);
    }
    state_ = {state_[0] + a, state_[1] + b, state_[2] + c, state_[3] + d};
  }

  std::vector<std::uint8_t> bytes_;
  std::array<std::uint32_t, 4> state_{0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476};
};

}  // namespace lxd::replay_test
