// SPDX-License-Identifier: Apache-2.0
// Outcomes on their way from the real-time thread to the one that writes.
#include <thread>

#include <gtest/gtest.h>

#include "board/outcome_mail.hpp"
#include "rt/allocation_guard.hpp"

namespace lxd::board_outcome_mail_test {
namespace {

SweepOutcome outcome_of(std::int64_t number, std::span<RegisteredPoint> points) {
  for (RegisteredPoint& point : points) point.intensity = static_cast<float>(number);
  SweepOutcome outcome;
  outcome.stamp = RigTime::from_ns(number);
  outcome.registered = points;
  return outcome;
}

bool is(const SweepOutcome& outcome, std::int64_t number, std::size_t points) {
  return outcome.stamp.ns() == number && outcome.registered.size() == points &&
         std::ranges::all_of(outcome.registered, [&](const RegisteredPoint& point) {
           return point.intensity == static_cast<float>(number);
         });
}

// Given outcomes whose points are gone after each post, then what arrives is whole and in order.
TEST(OutcomeMail, CopiesThePoints) {
  OutcomeMail mail;
  std::vector<RegisteredPoint> points(100);
  EXPECT_EQ(mail.front(), nullptr);
  ASSERT_TRUE(mail.post(outcome_of(1, points), {}));
  ASSERT_TRUE(mail.post(outcome_of(2, std::span(points).first(50)), {}));
  ASSERT_NE(mail.front(), nullptr);
  EXPECT_TRUE(is(mail.front()->outcome(), 1, 100));
  mail.release();
  EXPECT_TRUE(is(mail.front()->outcome(), 2, 50));
  mail.release();
  EXPECT_EQ(mail.front(), nullptr);
}

// Given what an image showed, and memory that the next one uses again, then each letter has its own.
TEST(OutcomeMail, CopiesWhatAnImageShowed) {
  OutcomeMail mail;
  std::vector<SightedFeature> features(kFeaturesMax);
  FilterView view;
  for (const float distance_m : {3.0F, 4.0F}) {
    features[5].distance_m = distance_m;
    view.sighted = {RigTime::from_seconds(1), Pose(), features};
    ASSERT_TRUE(mail.post({}, view));
  }
  ASSERT_TRUE(mail.post({}, {}));
  for (const float distance_m : {3.0F, 4.0F}) {
    ASSERT_EQ(mail.front()->view().sighted.features.size(), features.size());
    EXPECT_EQ(mail.front()->view().sighted.features[5].distance_m, distance_m);
    mail.release();
  }
  EXPECT_TRUE(mail.front()->view().sighted.features.empty());
}

TEST(OutcomeMail, RefusesWhatHasNoSlotAndGoesOn) {
  OutcomeMail mail;
  std::vector<RegisteredPoint> points(1);
  for (std::size_t i = 0; i < OutcomeMail::kSlots; ++i) ASSERT_TRUE(mail.post(outcome_of(1, points), {}));
  EXPECT_FALSE(mail.post(outcome_of(2, points), {}));
  mail.release();
  EXPECT_TRUE(mail.post(outcome_of(3, points), {}));
}

TEST(OutcomeMailRealTime, PostsWithoutAllocating) {
  OutcomeMail mail;
  std::vector<RegisteredPoint> points(1000);
  const SweepOutcome outcome = outcome_of(1, points);
  const AllocationGuard guard;
  (void)mail.post(outcome, {});
  const std::uint64_t allocations = guard.count();
  if (!AllocationGuard::active()) GTEST_SKIP() << "this build does not count allocations";
  EXPECT_EQ(allocations, 0U);
}

TEST(OutcomeMailThread, CarriesOutcomesBetweenTwoThreads) {
  constexpr std::int64_t kOutcomes = 2000;
  OutcomeMail mail;
  std::thread filter([&] {
    std::vector<RegisteredPoint> points(64);
    for (std::int64_t i = 0; i < kOutcomes; ++i) {
      const SweepOutcome outcome = outcome_of(i, points);
      while (!mail.post(outcome, {})) std::this_thread::yield();
    }
  });
  std::int64_t wrong = 0;
  for (std::int64_t i = 0; i < kOutcomes; ++i) {
    while (mail.front() == nullptr) std::this_thread::yield();
    wrong += !is(mail.front()->outcome(), i, 64);
    mail.release();
  }
  filter.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace lxd::board_outcome_mail_test
