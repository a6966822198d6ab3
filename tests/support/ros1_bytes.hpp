// SPDX-License-Identifier: Apache-2.0
// ROS 1 messages put together byte by byte, and what every parser of them must stand.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/ros1/wire_reader.hpp"

namespace lxd::test {

class Ros1Bytes {
 public:
  template <typename Number>
  Ros1Bytes& put(Number value) {
    const auto* const begin = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), begin, begin + sizeof(Number));
    return *this;
  }
  template <typename Number>
  Ros1Bytes& repeat(Number value, int times) {
    for (int i = 0; i < times; ++i) put(value);
    return *this;
  }
  Ros1Bytes& text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
    return *this;
  }
  Ros1Bytes& array(const std::vector<std::uint8_t>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    bytes.insert(bytes.end(), values.begin(), values.end());
    return *this;
  }
  // Sequence 7, in the frame "s".
  Ros1Bytes& header(std::uint32_t seconds, std::uint32_t nanos) {
    return put(std::uint32_t{7}).put(seconds).put(nanos).text("s");
  }
  // Of PointCloud2.
  Ros1Bytes& field(std::string_view name, std::uint32_t offset, std::uint8_t datatype) {
    return text(name).put(offset).put(datatype).put(std::uint32_t{1});
  }

  std::vector<std::uint8_t> bytes;
};

// Cut off at every length a message is `truncated`, and with a byte behind it `trailing_bytes`. The copy has no byte
// more than the message, so that the address sanitizer sees who reads beyond it.
template <typename Message>
void expect_told_when_cut(Ros1Fault (*read)(Ros1Reader::Bytes, Message&), const std::vector<std::uint8_t>& whole) {
  Message out;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto copy = std::make_unique<std::uint8_t[]>(size);
    std::memcpy(copy.get(), whole.data(), size);
    EXPECT_EQ(read({copy.get(), size}, out), Ros1Fault::truncated) << size;
  }
  std::vector<std::uint8_t> longer = whole;
  longer.push_back(0);
  EXPECT_EQ(read(longer, out), Ros1Fault::trailing_bytes);
}

// Whatever single bit is wrong, the parser comes back, and of what it says `check` may look at all.
template <typename Message, typename Check>
void expect_to_stand_every_bit(Ros1Fault (*read)(Ros1Reader::Bytes, Message&), const std::vector<std::uint8_t>& whole,
                               Check check) {
  constexpr std::size_t kBits = 8;
  Message out;
  for (std::size_t bit = 0; bit < kBits * whole.size(); ++bit) {
    const auto copy = std::make_unique<std::uint8_t[]>(whole.size());
    std::memcpy(copy.get(), whole.data(), whole.size());
    copy[bit / kBits] ^= static_cast<std::uint8_t>(1U << (bit % kBits));
    if (read({copy.get(), whole.size()}, out) == Ros1Fault::none) check(out);
  }
}

}  // namespace lxd::test
