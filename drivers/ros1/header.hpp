// SPDX-License-Identifier: Apache-2.0
// std_msgs/Header, with which messages of sensors begin.
#pragma once

#include <string_view>

#include "drivers/ros1/wire_reader.hpp"
#include "rt/time.hpp"

namespace lxd {

struct Ros1Header {
  RigTime stamp;           // since 1970; zero: the sender did not set it
  std::string_view frame;  // valid as long as the message

  [[nodiscard]] bool is_stamped() const { return stamp != RigTime(); }
};

inline Ros1Header read_ros1_header(Ros1Reader& reader) {
  Ros1Header header;
  (void)reader.number<std::uint32_t>();  // a count of messages
  const std::int64_t seconds = reader.number<std::uint32_t>();
  header.stamp = RigTime::from_ns(seconds * kNanosPerSecond + reader.number<std::uint32_t>());
  header.frame = reader.text();
  return header;
}

}  // namespace lxd
