// SPDX-License-Identifier: Apache-2.0
// Muted sensors as the user writes them, and when they are silent.
#include <gtest/gtest.h>

#include "board/mutes.hpp"

namespace lxd::board_mutes_test {
namespace {

TEST(Mutes, BeginIsSilentAndTheEndIsNot) {
  const std::vector<std::string> texts{"imu@10+0.5", "wheel@2"};
  const auto parsed = parse_mutes(texts);
  ASSERT_TRUE(parsed.ok());
  Mutes mutes(*parsed);
  const RigTime zero = RigTime::from_seconds(100);
  EXPECT_FALSE(mutes.silent("imu", zero + Duration::from_seconds(10.2)));  // nobody has said where zero is
  mutes.begin(zero);
  mutes.begin(zero + Duration::from_seconds(1));  // the first counts
  const auto silent = [&](std::string_view sensor, double t) {
    return mutes.silent(sensor, zero + Duration::from_seconds(t));
  };
  EXPECT_FALSE(silent("imu", 9.999));
  EXPECT_TRUE(silent("imu", 10));
  EXPECT_TRUE(silent("imu", 10.499));
  EXPECT_FALSE(silent("imu", 10.5));
  EXPECT_FALSE(silent("lidar0", 10.2));
  EXPECT_FALSE(silent("wheel", 1.9));
  EXPECT_TRUE(silent("wheel", 1e5));
}

struct BadMute {
  const char* text;
  const char* complaint;
};

class BadMutes : public testing::TestWithParam<BadMute> {};

TEST_P(BadMutes, AreNamedWithWhatIsWanted) {
  const auto mute = parse_mute(GetParam().text);
  ASSERT_FALSE(mute.ok());
  EXPECT_NE(mute.error().message.find(std::string("'") + GetParam().text + "'"), std::string::npos);
  EXPECT_NE(mute.error().message.find(GetParam().complaint), std::string::npos) << mute.error().message;
}

INSTANTIATE_TEST_SUITE_P(Texts, BadMutes,
                         testing::Values(BadMute{"", "lidar0 lidar1"}, BadMute{"lidar@3", "did you mean"},
                                         BadMute{"imu", "time at which it begins"}, BadMute{"imu@", "after '@'"},
                                         BadMute{"imu@-1", "after '@'"}, BadMute{"imu@nan", "after '@'"},
                                         BadMute{"imu@1+", "after '+'"}, BadMute{"imu@1+x", "after '+'"},
                                         BadMute{"imu@1+2s", "after '+'"}, BadMute{"imu@1e7", "after '@'"}));

}  // namespace
}  // namespace lxd::board_mutes_test
