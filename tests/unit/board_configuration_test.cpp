// SPDX-License-Identifier: Apache-2.0
// Where the numbers in force come from: defaults, the rig's sensors, the rig's settings, the command line, in this
// order.
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "board/configuration.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::board_configuration_test {
namespace {

namespace fs = std::filesystem;

class BoardConfiguration : public testing::Test {
 protected:
  void write_rig(const std::string& text, const std::string& name = "rig.yaml") const {
    std::ofstream(folder_ / name) << text;
  }
  [[nodiscard]] Result<Configuration> in_force(std::vector<std::string> choices = {}) const {
    return configure(folder_, std::nullopt, choices);
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(BoardConfiguration, WithoutARigFileIsTheDefaultsAndTheRecordingsLidar) {
  auto configuration = in_force();
  ASSERT_TRUE(configuration);
  complete_by(*configuration, {.beams = 64, .columns = 2000, .rate_hz = 10});
  EXPECT_EQ(configuration->rig.reference, "lidar0");
  EXPECT_EQ(configuration->rig.lidar0.beams, 64U);
  EXPECT_EQ(configuration->settings.estimator.range_sigma_m, EstimatorConfig{}.range_sigma_m);
  ASSERT_EQ(configuration->remarks.size(), 1U);
}

TEST_F(BoardConfiguration, TakesTheRigOfTheRecordingsFolder) {
  write_rig("reference: lidar0\nlidar0: {range_sigma_m: 0.01, range_m: [0.9, 80]}\n");
  const auto configuration = in_force();
  ASSERT_TRUE(configuration);
  EXPECT_EQ(configuration->settings.estimator.range_sigma_m, 0.01);
  EXPECT_EQ(configuration->settings.estimator.range_min_m, 0.9);
  EXPECT_EQ(configuration->settings.estimator.range_max_m, 80);
}

TEST_F(BoardConfiguration, ASensorThatSeesFartherDoesNotWidenTheDefault) {
  write_rig("reference: lidar0\nlidar0: {range_m: [0, 900]}\n");
  const auto configuration = in_force();
  ASSERT_TRUE(configuration);
  EXPECT_EQ(configuration->settings.estimator.range_min_m, EstimatorConfig{}.range_min_m);
  EXPECT_EQ(configuration->settings.estimator.range_max_m, EstimatorConfig{}.range_max_m);
}

TEST_F(BoardConfiguration, SettingsOfTheFileWinOverSensorsAndTheCommandLineOverBoth) {
  write_rig(
      "reference: lidar0\nlidar0: {range_m: [1, 80]}\n"
      "settings: {estimator.range_max_m: 70, mapping.cell_size_m: 0.5}\n");
  const auto configuration = in_force({"estimator.range_max_m=60"});
  ASSERT_TRUE(configuration);
  EXPECT_EQ(configuration->settings.estimator.range_max_m, 60);
  EXPECT_EQ(configuration->settings.mapping.cell_size_m, 0.5);
}

TEST_F(BoardConfiguration, AGivenRigFileComesBeforeTheFolders) {
  write_rig("lidar0: {beams: 16}\n");
  write_rig("lidar0: {beams: 32}\n", "mine.yaml");
  const auto configuration = configure(folder_, folder_ / "mine.yaml", {});
  ASSERT_TRUE(configuration);
  EXPECT_EQ(configuration->rig.lidar0.beams, 32U);
}

TEST_F(BoardConfiguration, TellsEveryWrongChoiceAtOnce) {
  const auto configuration = in_force({"mapping.cell_size=1", "threads=9", "loose"});
  ASSERT_FALSE(configuration);
  for (const char* part : {"mapping.cell_size:", "threads:", "'loose'"}) {
    EXPECT_NE(configuration.error().message.find(part), std::string::npos) << configuration.error().message;
  }
}

TEST_F(BoardConfiguration, ARigFileThatIsNotThereIsAnError) {
  EXPECT_FALSE(configure(folder_, folder_ / "missing.yaml", {}).ok());
}

}  // namespace
}  // namespace lxd::board_configuration_test
