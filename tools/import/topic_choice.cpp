// SPDX-License-Identifier: Apache-2.0
#include "tools/import/topic_choice.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace lxd {
namespace {

struct KindOfType {
  std::string_view type;
  MessageKind kind;
  std::string_view sensors;  // that such messages may be of, each with a blank behind it
};
constexpr std::array<KindOfType, 11> kTypes{
    {{"sensor_msgs/PointCloud2", MessageKind::point_cloud, "lidar0 lidar1 "},
     {"livox_ros_driver/CustomMsg", MessageKind::livox_points, "lidar0 lidar1 "},
     {"livox_ros_driver2/CustomMsg", MessageKind::livox_points, "lidar0 lidar1 "},
     {"sensor_msgs/Imu", MessageKind::inertial, "imu "},
     {"sensor_msgs/Image", MessageKind::picture, "camera0 "},
     {"sensor_msgs/CompressedImage", MessageKind::compressed_picture, "camera0 "},
     {"sensor_msgs/NavSatFix", MessageKind::satellite_fix, "gnss "},
     {"nmea_msgs/Sentence", MessageKind::sentence, "gnss "},
     {"geometry_msgs/PoseStamped", MessageKind::pose, "truth "},
     {"geometry_msgs/TransformStamped", MessageKind::transform, "truth "},
     {"nav_msgs/Odometry", MessageKind::odometry, "truth "}}};

const KindOfType* find_type(std::string_view type) {
  const auto* const found = std::ranges::find(kTypes, type, &KindOfType::type);
  return found == kTypes.end() ? nullptr : found;
}

bool fits(std::string_view type, std::string_view sensor) {
  const KindOfType* const known = find_type(type);
  return known != nullptr && known->sensors.find(fmt::format("{} ", sensor)) != std::string_view::npos;
}

std::vector<std::string_view> types_of(std::string_view sensor) {
  std::vector<std::string_view> types;
  for (const KindOfType& known : kTypes)
    if (fits(known.type, sensor)) types.push_back(known.type);
  return types;
}

std::vector<std::string> names_of(std::span<const BagTopic> topics) {
  std::vector<std::string> names;
  for (const BagTopic& topic : topics) names.push_back(fmt::format("{} ({})", topic.name, topic.type));
  return names;
}

class Chooser {
 public:
  Chooser(std::span<const BagTopic> topics, const Rig& rig) : topics_(topics) {
    sensors_.emplace_back("lidar0");
    if (rig.lidar1) sensors_.emplace_back("lidar1");
    if (rig.imu) sensors_.emplace_back("imu");
    if (rig.camera0) sensors_.emplace_back("camera0");
    if (rig.gnss) sensors_.emplace_back("gnss");
  }

  Status take_asked(const std::string& text) {
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos) return Error{fmt::format("--topic: found \"{}\", wanted e.g. lidar0=/points", text)};
    const std::string sensor = text.substr(0, sign), name = text.substr(sign + 1);
    if (sensor != "truth" && std::ranges::find(sensors_, sensor) == sensors_.end())
      return Error{fmt::format("--topic {}: found the sensor {}, wanted one of the rig file: {}, or truth", text,
                               sensor, fmt::join(sensors_, ", "))};
    if (is_chosen(sensor)) return Error{fmt::format("--topic {}: {} has a topic already", text, sensor)};
    if (name.empty() && sensor != "lidar0") {
      std::erase(sensors_, sensor);
      return success();
    }
    const auto topic = std::ranges::find(topics_, name, &BagTopic::name);
    if (topic == topics_.end())
      return Error{
          fmt::format("--topic {}: found no such topic, wanted one of {}", text, fmt::join(names_of(topics_), ", "))};
    if (!fits(topic->type, sensor))
      return Error{fmt::format("--topic {}: found messages of {}, wanted {}", text, topic->type,
                               fmt::join(types_of(sensor), " or "))};
    take(sensor, *topic);
    return success();
  }

  Status take_only_ones() {
    for (const std::string& sensor : sensors_) {
      if (is_chosen(sensor)) continue;
      const std::vector<BagTopic> fitting = fitting_for(sensor);
      if (fitting.size() > 1)
        return Error{fmt::format("{}: found {} topics that it may be: {}; choose one by --topic {}={}", sensor,
                                 fitting.size(), fmt::join(names_of(fitting), ", "), sensor, fitting.front().name)};
      if (fitting.size() == 1) take(sensor, fitting.front());
      if (fitting.empty() && sensor == "lidar0")
        return Error{fmt::format("lidar0: found no topic of {}, only {}", fmt::join(types_of(sensor), " or "),
                                 fmt::join(names_of(topics_), ", "))};
      if (fitting.empty()) choices_.remarks.push_back(fmt::format("{}: the bag has no topic that it may be", sensor));
    }
    return success();
  }

  TopicChoices give() { return std::move(choices_); }

 private:
  [[nodiscard]] bool is_chosen(const std::string& sensor) const {
    return std::ranges::find(choices_.topics, sensor, &TopicChoice::sensor) != choices_.topics.end();
  }
  [[nodiscard]] std::vector<BagTopic> fitting_for(const std::string& sensor) const {
    std::vector<BagTopic> fitting;
    for (const BagTopic& topic : topics_) {
      const bool free = std::ranges::find(choices_.topics, topic.name, &TopicChoice::topic) == choices_.topics.end();
      if (free && fits(topic.type, sensor)) fitting.push_back(topic);
    }
    return fitting;
  }
  void take(const std::string& sensor, const BagTopic& topic) {
    choices_.topics.push_back({sensor, topic.name, find_type(topic.type)->kind});
  }

  std::span<const BagTopic> topics_;
  std::vector<std::string> sensors_;  // of the rig
  TopicChoices choices_;
};

}  // namespace

Result<TopicChoices> choose_topics(std::span<const BagTopic> topics, const Rig& rig,
                                   std::span<const std::string> asked) {
  Chooser chooser(topics, rig);
  for (const std::string& text : asked)
    if (Status taken = chooser.take_asked(text); !taken) return taken.error();
  if (Status taken = chooser.take_only_ones(); !taken) return taken.error();
  return chooser.give();
}

}  // namespace lxd
