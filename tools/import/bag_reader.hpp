// SPDX-License-Identifier: Apache-2.0
// ROS 1 bags, by the rosbag storage library: what they hold, and their messages as bytes. The only part that knows the
// library.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/ros1/wire_reader.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"
#include "tools/import/topic_choice.hpp"

namespace lxd {

struct BagMessage {
  const std::string& topic;
  const std::string& type;
  RigTime received;  // when the bag was given it
  Ros1Reader::Bytes bytes;
};

class BagReader {
 public:
  // Error: the first of the files that is no whole bag: unreadable, another format, cut off before its index.
  static Result<BagReader> open(std::span<const std::filesystem::path> files);
  BagReader(BagReader&&) noexcept;
  BagReader& operator=(BagReader&&) = delete;
  ~BagReader();

  [[nodiscard]] const std::vector<BagTopic>& topics() const { return topics_; }  // by name
  [[nodiscard]] RigTime begin() const { return begin_; }
  [[nodiscard]] RigTime end() const { return end_; }

  // All messages of these topics, bag after bag in the order of their begins, each in the order of time. Ends with the
  // first error of `take`, or with its own, which names the bag.
  Status read(std::span<const std::string> topics, const std::function<Status(const BagMessage&)>& take);

 private:
  struct Bag;
  BagReader();
  void note_contents();

  std::vector<std::unique_ptr<Bag>> bags_;
  std::vector<BagTopic> topics_;
  RigTime begin_, end_;
};

}  // namespace lxd
