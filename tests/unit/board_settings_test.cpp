// SPDX-License-Identifier: Apache-2.0
// The settings table: every row works, and every wrong use is told what would be right.
#include <set>

#include <gtest/gtest.h>

#include "board/nearest_names.hpp"
#include "board/settings.hpp"

namespace lxd::board_settings_test {
namespace {

TEST(BoardSettings, ReachEveryFieldTheyName) {
  Settings settings;
  ASSERT_TRUE(set(settings, "mapping.cell_size_m", "0.5"));
  ASSERT_TRUE(set(settings, "estimator.iterations_max", "3"));
  ASSERT_TRUE(set(settings, "estimator.rotation_guess", "false"));
  ASSERT_TRUE(set(settings, "threads", "1"));
  EXPECT_EQ(settings.mapping.cell_size_m, 0.5);
  EXPECT_EQ(settings.estimator.iterations_max, 3);
  EXPECT_FALSE(settings.estimator.rotation_guess);
  EXPECT_EQ(settings.threads, 1);
}

TEST(BoardSettings, HaveDefaultsWithinTheirRangesAndKeysOfTheirOwn) {
  const Settings defaults;
  std::set<std::string> keys;
  for (const SettingChoice& choice : choices_of(defaults)) {
    Settings settings;
    const Status status = set(settings, choice.key, choice.value);
    EXPECT_TRUE(status) << status.error().message;
    EXPECT_TRUE(keys.insert(choice.key).second) << choice.key;
    EXPECT_FALSE(comment_of(choice.key).empty());
    EXPECT_NE(settings_reference().find(choice.key), std::string::npos);
  }
}

TEST(BoardSettings, ReadBackWhatTheyWriteToTheLastBit) {
  Settings odd;
  odd.mapping.cell_size_m = 1.0 / 3.0;
  odd.estimator.range_max_m = 123.456789012345678;
  Settings again;
  for (const SettingChoice& choice : choices_of(odd)) ASSERT_TRUE(set(again, choice.key, choice.value)) << choice.key;
  EXPECT_EQ(again.mapping.cell_size_m, odd.mapping.cell_size_m);
  EXPECT_EQ(again.estimator.range_max_m, odd.estimator.range_max_m);
}

struct Wrong {
  std::string key, value, said;
};
class BoardSettingsWrong : public testing::TestWithParam<Wrong> {};

TEST_P(BoardSettingsWrong, ChangesNothingAndSaysWhatIsWanted) {
  Settings settings;
  const Status status = set(settings, GetParam().key, GetParam().value);
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find(GetParam().said), std::string::npos) << status.error().message;
  const auto defaults = choices_of(Settings{});
  const auto after = choices_of(settings);
  for (std::size_t i = 0; i < defaults.size(); ++i) EXPECT_EQ(after[i].value, defaults[i].value);
}

const Wrong kWrong[] = {
    {"mapping.cell_sise_m", "1", "did you mean mapping.cell_size_m"},
    {"cell_size_m", "1", "mapping.cell_size_m"},
    {"zzzzzzzz", "1", "check --settings"},
    {"mapping.cell_size_m", "", "found '', wanted a number in 0.1 .. 10 m"},
    {"mapping.cell_size_m", "1m", "wanted a number"},
    {"mapping.cell_size_m", "nan", "wanted a number"},
    {"mapping.cell_size_m", "inf", "wanted a number"},
    {"mapping.cell_size_m", "1000", "0.1 .. 10 m"},
    {"mapping.cell_size_m", " 1", "wanted a number"},
    {"estimator.iterations_max", "2.5", "a whole number in 1 .. 50"},
    {"estimator.iterations_max", "99999999999999999999", "a whole number"},
    {"estimator.rotation_guess", "1", "true or false"},
    {"threads", "3", "1 .. 2"},
};
INSTANTIATE_TEST_SUITE_P(Values, BoardSettingsWrong, testing::ValuesIn(kWrong));

TEST(BoardSettings, ChoicesAreKeyEqualsValue) {
  EXPECT_EQ(parse_choice("a.b=c=d").value().value, "c=d");
  EXPECT_FALSE(parse_choice("a.b").ok());
  EXPECT_FALSE(parse_choice("=1").ok());
}

TEST(BoardNearestNames, CountTheUsualSlipsAsOne) {
  EXPECT_EQ(edit_distance("lidar0", "lidar0"), 0U);
  EXPECT_EQ(edit_distance("ldiar0", "lidar0"), 1U);
  EXPECT_EQ(edit_distance("lidar", "lidar0"), 1U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
}

}  // namespace
}  // namespace lxd::board_settings_test
