// SPDX-License-Identifier: Apache-2.0
// Which topic of a bag is which sensor of the rig: as was asked for, else the only one whose messages fit.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "board/rig.hpp"
#include "rt/result.hpp"

namespace lxd {

enum class MessageKind : std::uint8_t {
  point_cloud,
  livox_points,
  inertial,
  picture,
  compressed_picture,
  satellite_fix,
  sentence,
  pose,
  transform,
  odometry
};

struct BagTopic {
  std::string name, type;
  std::uint64_t messages = 0;
};

struct TopicChoice {
  std::string sensor;  // lidar0, lidar1, imu, camera0, gnss; truth
  std::string topic;
  MessageKind kind = MessageKind::point_cloud;
};

struct TopicChoices {
  std::vector<TopicChoice> topics;
  std::vector<std::string> remarks;  // sensors of the rig of which the bag has nothing
};

// `asked`: "lidar0=/os1_cloud_node/points" and so on; "camera0=" leaves it out. Truth is taken only when it is asked
// for. Errors: not of this form, a sensor that the rig has not, a topic that the bag has not or of another type;
// nothing for lidar0; several that fit one sensor, with their names.
Result<TopicChoices> choose_topics(std::span<const BagTopic> topics, const Rig& rig,
                                   std::span<const std::string> asked);

}  // namespace lxd
