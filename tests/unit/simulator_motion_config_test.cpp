// SPDX-License-Identifier: Apache-2.0
// What a scenario says of its motion: read, and refused where no motion can be made of it.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/motion_routes.hpp"
#include "tools/simulator/motion/make_motion.hpp"

namespace lxd::sim::simulator_motion_config_test {
namespace {

struct Refusal {
  MotionConfig config;
  double duration_s;
  const char* wanted;
};

TEST(SimulatorMotionErrors, SayWhatWasFoundAndWanted) {
  const double nan = std::nan("");
  const auto with = [](auto change) {
    MotionConfig config;
    change(config);
    return config;
  };
  const std::vector<Refusal> refusals{
      {MotionConfig{}, 0, "duration: found 0 s"},
      {MotionConfig{}, -3, "duration: found -3 s"},
      {MotionConfig{}, nan, "duration: found nan s"},
      {with([](auto& c) { c.carrier = "weeled"; }), 10, "motion.carrier: found 'weeled'"},
      {with([](auto& c) { c.route = "wlk"; }), 10, "motion.route: found 'wlk'"},
      {with([](auto& c) { c.route = "speck"; }), 10, "'speck' is 0.00 m long"},
      {with([](auto& c) { c.speed_mps = 30; }), 10, "motion.speed_mps: found 30"},
      {with([](auto& c) { c.rest_s = -1; }), 10, "motion.rest_s: found -1"},
      {with([](auto& c) { c.carrier = "car", c.route = "walk"; }), 10, "bends with a radius"},
      {with([](auto& c) { c.route = "dead end"; }), 10, "'dead end' turns back on itself"},
      {with([](auto& c) { c.carrier = "path", c.file = "/nonexistent/a.tum"; }), 10,
       "/nonexistent/a.tum: cannot be read"},
  };
  for (const Refusal& refusal : refusals) {
    const auto motion = make_motion(refusal.config, test::world_of_ways(), 1, refusal.duration_s);
    ASSERT_FALSE(motion.ok()) << refusal.wanted;
    EXPECT_NE(motion.error().message.find(refusal.wanted), std::string::npos) << motion.error().message;
  }
}

TEST(SimulatorMotionErrors, WorldWithoutRoutesAsksForAPath) {
  const auto motion = make_motion(MotionConfig{}, World{}, 1, 10);
  ASSERT_FALSE(motion.ok());
  EXPECT_NE(motion.error().message.find("carrier: path"), std::string::npos) << motion.error().message;
}

TEST(SimulatorMotionKeys, AreReadAndChecked) {
  Problems problems;
  YamlSection good(YAML::Load("{carrier: car, route: drive, speed_mps: 9, start: moving, vigour: 0.5}"), "motion", "f",
                   problems);
  MotionConfig config;
  read_keys(good, config);
  good.reject_unknown();
  EXPECT_TRUE(problems.empty()) << text_of(problems);
  EXPECT_EQ(config.carrier, "car");
  EXPECT_EQ(config.route, "drive");
  EXPECT_TRUE(config.start_moving);
  EXPECT_EQ(config.speed_mps, 9);
  EXPECT_EQ(config.vigour, 0.5);

  YamlSection bad(YAML::Load("{carrier: boat, speed_mps: 900, file: x.tum}"), "motion", "f", problems);
  read_keys(bad, config);
  bad.reject_unknown();
  EXPECT_EQ(problems.size(), 3U) << text_of(problems);
}

TEST(SimulatorMotionKeys, OfARecordedPath) {
  Problems problems;
  YamlSection section(YAML::Load("{carrier: path, file: a.tum, level: yes, file_start_s: 20, origin: [1, 2, 3, 90]}"),
                      "motion", "f", problems);
  MotionConfig config;
  read_keys(section, config);
  section.reject_unknown();
  EXPECT_TRUE(problems.empty()) << text_of(problems);
  EXPECT_TRUE(config.level);
  ASSERT_TRUE(config.origin);
  EXPECT_NEAR((*config.origin)[3], std::numbers::pi / 2, 1e-12);

  YamlSection without(YAML::Load("{carrier: path}"), "motion", "f", problems);
  MotionConfig none;
  read_keys(without, none);
  EXPECT_EQ(problems.size(), 1U) << text_of(problems);
}

}  // namespace
}  // namespace lxd::sim::simulator_motion_config_test
