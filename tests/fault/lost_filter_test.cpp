// SPDX-License-Identifier: Apache-2.0
// A filter that is lost begins again, and what it had before is not thrown away.
#include "tests/support/replay_layouts.hpp"
#include "tests/support/room_scan.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::lost_filter_test {
namespace {

// A LiDAR that stands in one room, and from one sweep to the next in another that is four times as large.
class TwoRooms : public replay_test::GenericLayout {
 public:
  TwoRooms(int in_one, int in_other) {
    std::vector<double> times_s;
    auto other = room_scan();
    for (auto& point : other)
      for (int axis : {0, 1, 2}) point[static_cast<std::size_t>(axis)] *= 4;
    for (int i = 0; i < in_one + in_other; ++i) {
      scan(i, i < in_one ? room_scan() : other);
      times_s.push_back(10 + 0.1 * i);
    }
    times(times_s);
  }
};

// Given a carrier that was put elsewhere, when no pose has held for a second, then the filter begins again there, and
// as nobody knows how the places lie to each other, the longer part is the run's map and the other is kept apart.
TEST(LostFilter, BeginsAgainAndSaysThatThePartsAreApart) {
  constexpr std::size_t kOne = 20, kOther = 90;
  const TwoRooms rooms(kOne, kOther);
  const TemporaryFolder folder;
  const Ended ended = lxd_slam(
      fmt::format("replay {} --set lost_after_s=1 --out {}", rooms.path().string(), (folder / "run").string()));
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_TRUE(ended.says("never found in the others")) << ended.text;
  const RunResult run(folder / "run");
  EXPECT_EQ(run.report()["map"]["pieces"], 2);
  EXPECT_EQ(run.report()["map"]["pieces_apart"], 1);
  const auto archive = Archive::open(run / "map.db");
  EXPECT_EQ(archive->totals().submeshes, 1U);
  EXPECT_EQ(archive->totals().submeshes_apart, 1U);
  EXPECT_EQ(run.path().size(), kOne + kOther);
  const auto in_map = run.path("trajectory.tum");
  EXPECT_LT(in_map.size(), kOther);
  EXPECT_GT(in_map.size(), kOther - 20);
  EXPECT_GT(in_map.front().stamp, RigTime::from_seconds(10 + 0.1 * kOne));
}

TEST(LostFilter, DoesNotWhenItIsTold) {
  const TwoRooms rooms(10, 30);
  const TemporaryFolder folder;
  const RunResult run = replayed(rooms.path(), folder, "--set lost_after_s=0");
  EXPECT_EQ(run.report()["map"]["pieces"], 1);
  EXPECT_EQ(run.path("trajectory.tum").size(), 40U);
}

}  // namespace
}  // namespace lxd::test::lost_filter_test
