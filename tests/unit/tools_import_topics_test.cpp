// SPDX-License-Identifier: Apache-2.0
// Which topic of a bag becomes which sensor.
#include <gtest/gtest.h>

#include "tools/import/topic_choice.hpp"

namespace lxd::tools_import_topics_test {
namespace {

const std::vector<BagTopic> kBag{{"/imu", "sensor_msgs/Imu", 10},
                                 {"/odom", "nav_msgs/Odometry", 10},
                                 {"/points", "sensor_msgs/PointCloud2", 5},
                                 {"/cam/left", "sensor_msgs/Image", 5},
                                 {"/cam/right", "sensor_msgs/Image", 5}};

Rig rig() {
  Rig rig;
  rig.imu.emplace();
  return rig;
}

std::string error_of(const Rig& of, const std::vector<std::string>& asked) {
  const auto choices = choose_topics(kBag, of, asked);
  return choices ? "" : choices.error().message;
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(ImportTopics, TheOnlyOneThatFitsIsTaken) {
  const auto choices = choose_topics(kBag, rig(), {});
  ASSERT_TRUE(choices) << choices.error().message;
  ASSERT_EQ(choices->topics.size(), 2U);  // no truth, unless it is asked for; no camera in the rig
  EXPECT_EQ(choices->topics[0].topic, "/points");
  EXPECT_EQ(choices->topics[1].topic, "/imu");
}

TEST(ImportTopics, OfSeveralTheUserChooses) {
  Rig seeing = rig();
  seeing.camera0.emplace();
  const std::string error = error_of(seeing, {});
  EXPECT_TRUE(says(error, "/cam/left") && says(error, "/cam/right") && says(error, "--topic camera0=")) << error;
  const std::vector<std::string> asked{"camera0=/cam/right", "truth=/odom"};
  const auto choices = choose_topics(kBag, seeing, asked);
  ASSERT_TRUE(choices) << choices.error().message;
  EXPECT_EQ(choices->topics[0].topic, "/cam/right");
  EXPECT_EQ(choices->topics[1].sensor, "truth");
  const std::vector<std::string> without{"camera0="};
  EXPECT_TRUE(choose_topics(kBag, seeing, without));
}

TEST(ImportTopics, WhatIsMissingIsSaid) {
  Rig located = rig();
  located.gnss.emplace();
  const auto choices = choose_topics(kBag, located, {});
  ASSERT_TRUE(choices);
  ASSERT_EQ(choices->remarks.size(), 1U);
  EXPECT_TRUE(says(choices->remarks[0], "gnss"));
  EXPECT_FALSE(choose_topics(std::span(kBag).first(1), rig(), {}));  // no LiDAR
}

TEST(ImportTopics, WhatIsAskedForWronglyIsNamed) {
  EXPECT_TRUE(says(error_of(rig(), {"lidar0"}), "wanted e.g. lidar0="));
  EXPECT_TRUE(says(error_of(rig(), {"camera0=/cam/left"}), "wanted one of the rig file"));
  EXPECT_TRUE(says(error_of(rig(), {"lidar0=/nothing"}), "no such topic"));
  EXPECT_TRUE(says(error_of(rig(), {"lidar0=/imu"}), "wanted sensor_msgs/PointCloud2"));
  EXPECT_TRUE(says(error_of(rig(), {"lidar0=/points", "lidar0=/points"}), "already"));
  EXPECT_TRUE(says(error_of(rig(), {"lidar0="}), "no such topic"));
}

}  // namespace
}  // namespace lxd::tools_import_topics_test
