// SPDX-License-Identifier: Apache-2.0
// Scenarios: those that come with the program, and what a user's file may say.
#include <gtest/gtest.h>

#include "board/rig_file.hpp"
#include "board/rig_text.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/rig_of_scenario.hpp"
#include "tools/simulator/scenario.hpp"
#include "tools/simulator/shipped_scenarios.hpp"
#include "tools/simulator/simulation.hpp"

namespace lxd::sim::simulator_scenario_test {
namespace {

constexpr const char* kSmall = "world: field\nmotion: {carrier: wheeled}\nlidar0: {model: livox}\n";

std::string complaint(const std::string& text) {
  const auto scenario = parse_scenario(text, "my.yaml");
  return scenario ? "" : scenario.error().message;
}

class ShippedScenarios : public testing::TestWithParam<ShippedScenario> {};

// Given any scenario of the program, when its world and its motion are made, then the way is free, the sensors can work
// so, and the rig file that it would get is sound.
TEST_P(ShippedScenarios, CanBeSimulatedAndTheirRigIsSound) {
  test::TemporaryFolder folder;
  for (const std::uint64_t seed : {0U, 100U}) {
    auto scenario = load_scenario(std::string(GetParam().name));
    ASSERT_TRUE(scenario) << scenario.error().message;
    const RigFile rig = parse_rig(rig_text(rig_of(*scenario, seed)), "rig.yaml");
    EXPECT_TRUE(rig.ok()) << text_of(rig.problems);
    SimulateRequest request;
    request.scenario = *scenario;
    request.seed = seed;
    request.out = folder.path() / "out";
    const auto simulation = Simulation::prepare(std::move(request));
    EXPECT_TRUE(simulation) << simulation.error().message;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenarios,
                         testing::ValuesIn(shipped_scenarios().begin(), shipped_scenarios().end()),
                         [](const auto& scenario) { return std::string(scenario.param.name); });

TEST(Scenario, TakesTheDefaultsOfWhatItLeavesOut) {
  const auto scenario = parse_scenario(kSmall, "my.yaml");
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->name, "my");
  EXPECT_EQ(scenario->duration_s, 60);
  EXPECT_TRUE(std::holds_alternative<LivoxConfig>(scenario->lidar0));
  EXPECT_FALSE(scenario->imu);
}

TEST(Scenario, BeginsWhenItSays) {
  const auto scenario = parse_scenario(std::string(kSmall) + "start: 2026-06-01T08:30:00Z\n", "my.yaml");
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->start.ns(), 1'780'302'600LL * kNanosPerSecond);
  for (const char* const wrong :
       {"2026-06-01", "2026-13-01T08:30:00Z", "2026-06-01T25:30:00Z", "2026-06-01T08:30:00Zx"})
    EXPECT_NE(complaint(std::string(kSmall) + "start: " + wrong + "\n").find("start"), std::string::npos) << wrong;
}

TEST(Scenario, WithoutWhatItNeedsNamesAllOfIt) {
  const std::string said = complaint("notes: none\n");
  for (const char* const key : {"world", "motion", "lidar0"}) EXPECT_NE(said.find(key), std::string::npos) << said;
}

TEST(Scenario, WithAClockInOtherUnitsIsToldWhereAndWhat) {
  const std::string said = complaint(
      "world: field\nmotion: {carrier: wheeled}\nlidar0: {model: ouster, clock: {jitter_s: 5, skw_ppm: 3}}\n");
  EXPECT_NE(said.find("my.yaml:3: lidar0.clock.jitter_s"), std::string::npos) << said;
  EXPECT_NE(said.find("is it in milliseconds?"), std::string::npos) << said;
  EXPECT_NE(said.find("did you mean skew_ppm"), std::string::npos) << said;
}

TEST(Scenario, ThatMistypesAKeyIsToldEachNearOneOnce) {
  const std::string said = complaint(std::string(kSmall) + "worl: {file: my.ply}\n");
  EXPECT_NE(said.find("did you mean world?"), std::string::npos) << said;
}

// Given a scenario that lies with its files in a folder, when it is read from anywhere, then they are those beside it.
TEST(Scenario, FindsTheFilesThatItNamesBesideItself) {
  const std::string text =
      "world: {file: scans/my.ply}\nmotion: {carrier: path, file: walk.tum}\nlidar0: {model: livox}\n";
  const auto there = parse_scenario(text, "rigs/one/my.yaml");
  ASSERT_TRUE(there) << there.error().message;
  EXPECT_EQ(there->world, "rigs/one/scans/my.ply");
  EXPECT_EQ(there->motion.file, "rigs/one/walk.tum");
  const auto here = parse_scenario(text, "my.yaml");
  ASSERT_TRUE(here);
  EXPECT_EQ(here->motion.file, "walk.tum");
  const auto anywhere = parse_scenario(
      "world: {file: /a/my.ply}\nmotion: {carrier: path, file: /b/walk.tum}\nlidar0: {model: livox}\n", "rigs/my.yaml");
  ASSERT_TRUE(anywhere);
  EXPECT_EQ(anywhere->world, "/a/my.ply");
  EXPECT_EQ(anywhere->motion.file, "/b/walk.tum");
}

TEST(Scenario, ThatIsNoYamlSaysSo) { EXPECT_NE(complaint("world: [").find("no sound YAML"), std::string::npos); }

TEST(RigOfScenario, IsThatOfTheImuWhereItSitsAtTheBody) {
  const auto with = [](const char* imu) {
    const auto scenario = parse_scenario(std::string(kSmall) + imu, "my.yaml");
    return scenario ? rig_of(*scenario, 0).reference : scenario.error().message;
  };
  EXPECT_EQ(with("imu: {}\n"), "imu");
  EXPECT_EQ(with("imu: {T_body_sensor: [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}\n"), "body");
  EXPECT_EQ(with(""), "body");
}

}  // namespace
}  // namespace lxd::sim::simulator_scenario_test
