// SPDX-License-Identifier: Apache-2.0
// Beams of a sub-mesh, on the disk and back.
#include <gtest/gtest.h>

#include "backend/beam_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::backend_beam_log_test {
namespace {

using Eigen::Vector3d;
using Return = BeamSweep::Return;

std::vector<Beam> read(const BeamLog& log) {
  BeamReader reader(log);
  std::vector<Beam> beams;
  for (auto some = reader.next(); !some.empty(); some = reader.next())
    beams.insert(beams.end(), some.begin(), some.end());
  EXPECT_TRUE(reader.status());
  return beams;
}

struct Logged {
  test::TemporaryFolder folder;
  Result<BeamLog> log = BeamLog::create(folder.path());

  Status add(const Vector3d& then_m, const Vector3d& now_m, const std::vector<Return>& returns) {
    return log->add({then_m, now_m, returns});
  }
};

// Given a LiDAR that goes a metre during a sweep, 5 km from the world's origin, then each return comes back with the
// place that it was seen from, to within four millimetres.
TEST(BeamLog, GivesBackWhereEachReturnWasSeenFrom) {
  Logged logged;
  const Vector3d now(5000, -3000, 12), way(1, 0.5, 0);
  const std::vector<Return> returns{{now + Vector3d(10, -20, 1.5), 1}, {now + Vector3d(-129, 7, 0), 0.25F}, {now, 0}};
  ASSERT_TRUE(logged.add(now - way, now, returns));
  const auto beams = read(*logged.log);
  ASSERT_EQ(beams.size(), returns.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    EXPECT_LT((beams[i].to_m - returns[i].p_m).norm(), 0.004);
    EXPECT_LT((beams[i].from_m - (now - returns[i].to_come * way)).norm(), 1e-4);
  }
}

TEST(BeamLog, SweepsComeBackInOrderAndSweepsWithoutReturnsAreNoEnd) {
  Logged logged;
  for (int i = 0; i < 10; ++i)
    ASSERT_TRUE(logged.add({0, 0, 0}, {0, 0, 0}, std::vector<Return>(i % 3, {Vector3d(i, 0, 0), 0})));
  const auto beams = read(*logged.log);
  ASSERT_EQ(beams.size(), 9U);
  EXPECT_NEAR(beams.front().to_m.x(), 1, 0.004);
  EXPECT_NEAR(beams.back().to_m.x(), 8, 0.004);
}

// The limit of the reach, below and at it; and what is no number.
TEST(BeamLog, LeavesOutWhatItCannotHold) {
  Logged logged;
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(logged.add(
      {0, 0, 0}, {0, 0, 0},
      {{{BeamLog::kReach_m - 0.01, 0, 0}, 0}, {{0, -BeamLog::kReach_m, 0}, 0}, {{kNowhere, 0, 0}, 0}, {{0, 0, 1}, 0}}));
  EXPECT_EQ(read(*logged.log).size(), 2U);
  EXPECT_EQ(logged.log->count(), 2U);
}

TEST(BeamLog, IsEmptyAfterClear) {
  Logged logged;
  ASSERT_TRUE(logged.add({0, 0, 0}, {0, 0, 0}, {{{1, 0, 0}, 0}}));
  logged.log->clear();
  EXPECT_TRUE(read(*logged.log).empty());
  ASSERT_TRUE(logged.add({0, 0, 0}, {0, 0, 0}, {{{2, 0, 0}, 0}}));
  EXPECT_EQ(read(*logged.log).size(), 1U);
}

// Given a rig that stands for hours, then the log grows with the logarithm of the time: the first strides hold so many
// beams each, whatever comes.
TEST(BeamLog, GrowsEverSlower) {
  Logged logged;
  constexpr int kReturns = 8192;
  const std::vector<Return> returns(kReturns, {Vector3d(1, 2, 3), 0});
  constexpr auto kSweeps = static_cast<int>(BeamLog::kBeamsAStride / kReturns);
  const auto stand = [&](int sweeps) {
    for (int i = 0; i < sweeps; ++i) ASSERT_TRUE(logged.add({0, 0, 0}, {0, 0, 0}, returns));
  };
  stand(kSweeps);
  EXPECT_EQ(logged.log->count(), BeamLog::kBeamsAStride);
  stand(2 * kSweeps);
  EXPECT_EQ(logged.log->count(), 2 * BeamLog::kBeamsAStride);
  stand(4 * kSweeps);
  EXPECT_EQ(logged.log->count(), 3 * BeamLog::kBeamsAStride);
}

TEST(BeamLog, SaysWhereItCannotBe) {
  const auto log = BeamLog::create("/proc/no/such/folder");
  ASSERT_FALSE(log);
  EXPECT_NE(log.error().message.find("/proc/no/such/folder"), std::string::npos);
}

}  // namespace
}  // namespace lxd::backend_beam_log_test
