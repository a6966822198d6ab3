// SPDX-License-Identifier: Apache-2.0
// A ROS 1 bag, written by the rosbag storage library from messages as bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <rosbag/bag.h>

#include "rt/time.hpp"

namespace lxd::test {

struct RawMessage {
  std::string type;
  std::vector<std::uint8_t> bytes;
};

class BagFile {
 public:
  explicit BagFile(const std::filesystem::path& path) : bag_(path.string(), rosbag::bagmode::Write) {}

  void write(const std::string& topic, RigTime received, const RawMessage& message) {
    ros::Time time;
    bag_.write(topic, time.fromNSec(static_cast<std::uint64_t>(received.ns())), message);
  }

 private:
  rosbag::Bag bag_;
};

}  // namespace lxd::test

// What the library asks of a message.
namespace ros {
namespace message_traits {

template <>
struct MD5Sum<lxd::test::RawMessage> {
  static const char* value() { return "*"; }
  static const char* value(const lxd::test::RawMessage&) { return value(); }
};
template <>
struct DataType<lxd::test::RawMessage> {
  static const char* value(const lxd::test::RawMessage& message) { return message.type.c_str(); }
};
template <>
struct Definition<lxd::test::RawMessage> {
  static const char* value(const lxd::test::RawMessage&) { return ""; }
};

}  // namespace message_traits
namespace serialization {

template <>
struct Serializer<lxd::test::RawMessage> {
  template <typename Stream>
  static void write(Stream& stream, const lxd::test::RawMessage& message) {
    std::copy(message.bytes.begin(), message.bytes.end(),
              stream.advance(static_cast<std::uint32_t>(message.bytes.size())));
  }
  static std::uint32_t serializedLength(const lxd::test::RawMessage& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};

}  // namespace serialization
}  // namespace ros
