// SPDX-License-Identifier: Apache-2.0
// Wrong times in folder recordings: one wrong stamp or one wrong offset costs itself, not what comes after it.
#include "tests/support/replay_layouts.hpp"

namespace lxd::source_times_test {
namespace {

using namespace replay_test;

class LeapingFolder : public testing::TestWithParam<LayoutCase> {
 protected:
  // Sequence numbers of the sweeps that are read, and the counts.
  std::vector<std::uint32_t> read(const std::vector<double>& times_s) {
    const auto layout = GetParam().make();
    for (std::size_t i = 0; i < times_s.size(); ++i) layout->good_scan(static_cast<int>(i));
    layout->times(times_s);
    const auto source = must_open(layout->path());
    std::vector<std::uint32_t> numbers;
    for (const OwnedSweep& sweep : read_all(*source)) {
      if (numbers.empty()) first_begin_ = sweep.header.begin;
      numbers.push_back(sweep.header.sequence);
    }
    rejected_ = source->rejected();
    return numbers;
  }

  RigTime first_begin_;
  Counts rejected_;
};

using Numbers = std::vector<std::uint32_t>;

TEST_P(LeapingFolder, OneLeapingStampLosesItsSweepOnly) {
  EXPECT_EQ(read({10, 10.1, 50.2, 10.3, 10.4, 10.5}), (Numbers{0, 1, 3, 4, 5}));
  EXPECT_EQ(rejected_, (Counts{{"time_leap", 1}}));
}

TEST_P(LeapingFolder, LeapingFirstStampIsNotWhereRigTimeBegins) {
  EXPECT_EQ(read({50, 10.1, 10.2, 10.3}), (Numbers{1, 2, 3}));
  EXPECT_EQ(rejected_, (Counts{{"time_leap", 1}}));
  const bool kitti_raw = std::string(GetParam().kind) == "kitti-raw";  // its zero is the first stamp, in mid turn
  EXPECT_NEAR(first_begin_.seconds(), kitti_raw ? -0.05 : 10.1, 1e-6);
}

TEST_P(LeapingFolder, GapForwardLosesNothing) {
  EXPECT_EQ(read({10, 10.1, 50.2, 50.3}), (Numbers{0, 1, 2, 3}));
  EXPECT_TRUE(rejected_.empty());
}

INSTANTIATE_TEST_SUITE_P(Kinds, LeapingFolder, testing::ValuesIn(every_layout()),
                         [](const auto& param) { return letters_of(param.param.kind); });

// Sweeps of 2000 points at 10 Hz that end 0.1 s after they began.
class GenericOffsets : public testing::Test {
 protected:
  static constexpr int kSweeps = 4, kPoints = 2000, kDamaged = 1;

  // offset_s(i): of point i of the damaged sweep.
  template <typename Offset>
  std::vector<OwnedSweep> read(Offset&& offset_s) {
    GenericLayout layout;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      std::vector<float> floats;
      for (int i = 0; i < kPoints; ++i) {
        const float sound_s = 0.1F * static_cast<float>(i + 1) / kPoints;
        floats.insert(floats.end(), {1, 2, 3, 0, sweep == kDamaged ? offset_s(i, sound_s) : sound_s});
      }
      write_floats(layout.file(sweep), floats);
    }
    layout.times({10, 10.1, 10.2, 10.3});
    const auto source = must_open(layout.path());
    auto sweeps = read_all(*source);
    rejected_ = source->rejected();
    return sweeps;
  }
  static double duration_s(const OwnedSweep& sweep) { return (sweep.header.end - sweep.header.begin).seconds(); }

  Counts rejected_;
};

TEST_F(GenericOffsets, PointOfAnotherTurnIsDropped) {
  const auto sweeps = read([](int i, float sound_s) { return i == 700 ? 0.95F : sound_s; });
  ASSERT_EQ(sweeps.size(), 4U);
  EXPECT_EQ(sweeps[kDamaged].points.size(), kPoints - 1U);
  EXPECT_NEAR(duration_s(sweeps[kDamaged]), 0.1, 1e-6);
  EXPECT_EQ(rejected_, (Counts{{"bad_point_time", 1}}));
}

TEST_F(GenericOffsets, LonePointSoonAfterTheTurnDoesNotMoveItsEnd) {
  const auto sweeps = read([](int i, float sound_s) { return i == 700 ? 0.14F : sound_s; });
  ASSERT_EQ(sweeps.size(), 4U);
  EXPECT_NEAR(duration_s(sweeps[kDamaged]), 0.1, 1e-6);
  EXPECT_EQ(sweeps[kDamaged].points.size(), kPoints - 1U);
  EXPECT_NEAR(sweeps[kDamaged].points[700].offset_ns, 35.1e6, 100);  // the next one took its place
  EXPECT_EQ(rejected_, (Counts{{"bad_point_time", 1}}));
}

TEST_F(GenericOffsets, TurnThatTakesLongerThanOthersIsKeptWhole) {
  const auto sweeps = read([](int, float sound_s) { return 1.4F * sound_s; });
  ASSERT_EQ(sweeps.size(), 4U);
  EXPECT_EQ(sweeps[kDamaged].points.size(), std::size_t{kPoints});
  EXPECT_NEAR(duration_s(sweeps[kDamaged]), 0.14, 1e-6);
  EXPECT_TRUE(rejected_.empty());
}

TEST_F(GenericOffsets, MillisecondsAreRefusedPointByPoint) {
  const auto sweeps = read([](int, float sound_s) { return 1000 * sound_s; });
  ASSERT_EQ(sweeps.size(), 4U);
  EXPECT_EQ(sweeps[kDamaged].points.size(), 3U);  // below 0.15
  EXPECT_EQ(rejected_, (Counts{{"bad_point_time", kPoints - 3U}}));
}

}  // namespace
}  // namespace lxd::source_times_test
