// SPDX-License-Identifier: Apache-2.0
// Faults as users write them.
#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "tools/simulator/fault_text.hpp"

namespace lxd::sim::simulator_fault_text_test {
namespace {

constexpr double kToTheEnd = std::numeric_limits<double>::infinity();
constexpr std::array kKnown{KnownFault{"lidar0_loss", kToTheEnd, 0.1, "part", "packets lost"},
                            KnownFault{"lidar0_off", 5, 0, "", "no packets at all"}};

TEST(FaultText, WithItsNameAloneTakesTheDefaults) {
  const auto fault = parse_fault("lidar0_off", kKnown);
  ASSERT_TRUE(fault) << fault.error().message;
  EXPECT_EQ(fault->begin_s, 0);
  EXPECT_EQ(fault->end_s, 5);
  const auto endless = parse_fault("lidar0_loss", kKnown);
  ASSERT_TRUE(endless);
  EXPECT_EQ(endless->end_s, kToTheEnd);
  EXPECT_EQ(endless->value, 0.1);
}

TEST(FaultText, WithBeginDurationAndValueTakesThem) {
  const auto fault = parse_fault("lidar0_loss@10.5+2=0.33", kKnown);
  ASSERT_TRUE(fault) << fault.error().message;
  EXPECT_EQ(fault->begin_s, 10.5);
  EXPECT_EQ(fault->end_s, 12.5);
  EXPECT_EQ(fault->value, 0.33);
}

TEST(FaultText, ThatIsMistypedNamesTheNearest) {
  const auto fault = parse_fault("lidar0_los", kKnown);
  ASSERT_FALSE(fault);
  EXPECT_NE(fault.error().message.find("did you mean lidar0_loss"), std::string::npos) << fault.error().message;
}

TEST(FaultText, WithAnyPartWrongIsRefused) {
  for (const char* const text :
       {"", "@3", "lidar0_loss@", "lidar0_loss@-1", "lidar0_loss@1+0", "lidar0_loss@1+-2",
        "lidar0_loss=", "lidar0_loss=many", "lidar0_loss=nan", "lidar0_off=1", "lidar0_loss@inf", "lidar0_loss=1.1",
        "lidar0_loss=-0.1", "lidar0_loss@1+2x", "lidar0_loss=1=2"}) {
    const auto fault = parse_fault(text, kKnown);
    ASSERT_FALSE(fault) << text;
    EXPECT_NE(fault.error().message.find(text), std::string::npos);
  }
}

TEST(FaultPlan, ListsEveryMistakeAtOnce) {
  const std::array<std::string, 3> texts{"lidar0_loss@70", "imu_gap", "lidar0_off@1"};
  const auto plan = plan_faults(texts, kKnown, 60);
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("lidar0_loss@70"), std::string::npos);
  EXPECT_NE(plan.error().message.find("imu_gap"), std::string::npos);
  EXPECT_EQ(plan.error().message.find("lidar0_off@1"), std::string::npos);
}

TEST(FaultPlan, RefusesTwoOfANameThatOverlapAndNamesBoth) {
  const auto said = [](const std::vector<std::string>& texts) {
    const auto plan = plan_faults(texts, kKnown, 60);
    return plan ? std::string() : plan.error().message;
  };
  const std::string told = said({"lidar0_off@1+5", "lidar0_loss", "lidar0_off@3+1"});
  EXPECT_NE(told.find("'lidar0_off@1+5'"), std::string::npos) << told;
  EXPECT_NE(told.find("'lidar0_off@3+1'"), std::string::npos) << told;
  EXPECT_EQ(told.find("lidar0_loss"), std::string::npos) << told;
  EXPECT_NE(said({"lidar0_loss@1", "lidar0_loss@2"}), "") << "the first lasts to the end";
  EXPECT_EQ(said({"lidar0_off@3+1", "lidar0_off@1+2"}), "") << "one after the other";
}

TEST(FaultPlan, KnowsWhatIsOnAtATime) {
  const std::array<std::string, 2> texts{"lidar0_off@1+2", "lidar0_loss@2=0.5"};
  const auto plan = plan_faults(texts, kKnown, 60);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->active("lidar0_off", 0.999), nullptr);
  EXPECT_NE(plan->active("lidar0_off", 1), nullptr);
  EXPECT_EQ(plan->active("lidar0_off", 3), nullptr);
  ASSERT_NE(plan->active("lidar0_loss", 50), nullptr);
  EXPECT_EQ(plan->active("lidar0_loss", 50)->value, 0.5);
}

}  // namespace
}  // namespace lxd::sim::simulator_fault_text_test
