// SPDX-License-Identifier: Apache-2.0
#include "tools/import/bag_reader.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

namespace lxd {
namespace {

namespace fs = std::filesystem;

RigTime rig_time(const ros::Time& t) { return RigTime::from_ns(static_cast<std::int64_t>(t.toNSec())); }

// The library's words, behind the file's name.
Error unreadable(const fs::path& file, const std::exception& cause) {
  return Error{fmt::format("{}: cannot be read as a ROS 1 bag: {}", file.string(), cause.what())};
}

// The library would go on to serialise into what it is given; this takes the bytes as they are.
std::span<const std::uint8_t> bytes_of(const rosbag::MessageInstance& message, std::vector<std::uint8_t>& buffer) {
  const std::uint32_t size = message.size();
  if (buffer.size() < size) buffer.resize(size);
  ros::serialization::OStream stream(buffer.data(), size);
  message.write(stream);
  return std::span(buffer).first(size);
}

}  // namespace

struct BagReader::Bag {
  fs::path file;
  rosbag::Bag bag;
  RigTime begin, end;
  bool empty = true;
};

BagReader::BagReader() = default;
BagReader::BagReader(BagReader&&) noexcept = default;
BagReader::~BagReader() = default;

Result<BagReader> BagReader::open(std::span<const fs::path> files) {
  BagReader reader;
  for (const fs::path& file : files) {
    std::error_code error;
    if (!fs::is_regular_file(file, error))
      return Error{fmt::format("{}: found no such file, wanted a ROS 1 bag", file.string())};
    auto bag = std::make_unique<Bag>();
    bag->file = file;
    try {
      bag->bag.open(file.string(), rosbag::bagmode::Read);
      rosbag::View all(bag->bag);
      bag->empty = all.size() == 0;
      if (!bag->empty) bag->begin = rig_time(all.getBeginTime());
      if (!bag->empty) bag->end = rig_time(all.getEndTime());
      reader.bags_.push_back(std::move(bag));
      reader.note_contents();
    } catch (const std::exception& cause) {
      return unreadable(file, cause);
    }
  }
  std::ranges::stable_sort(reader.bags_, {}, [](const auto& bag) { return bag->begin; });
  return reader;
}

// Adds the newest bag's topics and span.
void BagReader::note_contents() {
  const Bag& added = *bags_.back();
  std::map<std::string, BagTopic> topics;
  for (BagTopic& topic : topics_) topics[topic.name] = std::move(topic);
  rosbag::View all(added.bag);
  for (const rosbag::ConnectionInfo* const connection : all.getConnections()) {
    BagTopic& topic = topics[connection->topic];
    topic.name = connection->topic;
    topic.type = connection->datatype;
  }
  for (auto& [name, topic] : topics) topic.messages += rosbag::View(added.bag, rosbag::TopicQuery(name)).size();
  topics_.clear();
  for (auto& [name, topic] : topics) topics_.push_back(std::move(topic));
  if (added.empty) return;
  const bool first = begin_ == RigTime() && end_ == RigTime();
  begin_ = first ? added.begin : std::min(begin_, added.begin);
  end_ = std::max(end_, added.end);
}

Status BagReader::read(std::span<const std::string> topics, const std::function<Status(const BagMessage&)>& take) {
  const std::vector<std::string> wanted(topics.begin(), topics.end());
  std::vector<std::uint8_t> buffer;
  for (const auto& bag : bags_) {
    try {
      rosbag::View view(bag->bag, rosbag::TopicQuery(wanted));
      for (const rosbag::MessageInstance& message : view) {
        const auto bytes = bytes_of(message, buffer);
        const Status taken = take({message.getTopic(), message.getDataType(), rig_time(message.getTime()), bytes});
        if (!taken) return taken;
      }
    } catch (const std::exception& cause) {
      return unreadable(bag->file, cause);
    }
  }
  return success();
}

}  // namespace lxd
