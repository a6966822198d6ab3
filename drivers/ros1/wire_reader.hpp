// SPDX-License-Identifier: Apache-2.0
// The bytes of a ROS 1 message, field by field: little endian, without gaps; strings and arrays have their number of
// elements before them, as uint32. Never reads beyond the message: after the first field that is not whole everything
// is zero or empty, and ok() is false.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "drivers/ros1/fault.hpp"

namespace lxd {

static_assert(std::endian::native == std::endian::little, "messages hold little-endian numbers");

class Ros1Reader {
 public:
  using Bytes = std::span<const std::uint8_t>;

  explicit Ros1Reader(Bytes message) : rest_(message) {}

  template <typename Number>
  Number number() {
    Number value{};
    const Bytes field = bytes(sizeof(Number));
    if (!field.empty()) std::memcpy(&value, field.data(), sizeof(Number));
    return value;
  }

  Bytes bytes(std::uint64_t count) {
    if (count > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const Bytes field = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(static_cast<std::size_t>(count));
    return field;
  }

  // An array of uint8; of elements of so many bytes each.
  Bytes array(std::uint32_t element_bytes = 1) { return bytes(std::uint64_t{number<std::uint32_t>()} * element_bytes); }

  // Valid as long as the message.
  std::string_view text() {
    const Bytes field = array();
    return {reinterpret_cast<const char*>(field.data()), field.size()};
  }

  [[nodiscard]] bool ok() const { return ok_; }
  // At the message's end: was it whole, and is there nothing behind it.
  [[nodiscard]] Ros1Fault finish() const {
    if (!ok_) return Ros1Fault::truncated;
    return rest_.empty() ? Ros1Fault::none : Ros1Fault::trailing_bytes;
  }

 private:
  Bytes rest_;
  bool ok_ = true;
};

}  // namespace lxd
