// SPDX-License-Identifier: Apache-2.0
// Folder recordings, sound and damaged: what is wrong is counted by cause and passed over, never guessed, never fatal.
#include <limits>

#include "tests/support/replay_layouts.hpp"

namespace lxd::source_folder_test {
namespace {

using namespace replay_test;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

class ReplayFolder : public testing::TestWithParam<LayoutCase> {
 protected:
  void SetUp() override { layout_ = GetParam().make(); }

  // Opens, reads all, and keeps the counts.
  std::vector<OwnedSweep> read(std::size_t capacity = 1000) {
    const auto source = must_open(layout_->path());
    if (source == nullptr) return {};
    auto sweeps = read_all(*source, capacity);
    rejected_ = source->rejected();
    return sweeps;
  }
  static std::vector<std::uint32_t> numbers(const std::vector<OwnedSweep>& sweeps) {
    std::vector<std::uint32_t> all;
    for (const OwnedSweep& sweep : sweeps) all.push_back(sweep.header.sequence);
    return all;
  }

  std::unique_ptr<ReplayLayout> layout_;
  Counts rejected_;
};

using Numbers = std::vector<std::uint32_t>;

TEST_P(ReplayFolder, SoundRecordingIsReadWhole) {
  for (int i = 0; i < 3; ++i) layout_->good_scan(i);
  layout_->times({1, 1.1, 1.2});
  const auto source = must_open(layout_->path());
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(source->kind(), GetParam().kind);
  EXPECT_EQ(source->size(), 3U);
  EXPECT_NEAR(source->traits().rate_hz, 10, 1e-6);
  const auto sweeps = read_all(*source);
  EXPECT_EQ(numbers(sweeps), (Numbers{0, 1, 2}));
  EXPECT_TRUE(source->rejected().empty());
  EXPECT_TRUE(source->notes().empty());
  for (const OwnedSweep& sweep : sweeps) {
    ASSERT_EQ(sweep.points.size(), 3U);
    EXPECT_EQ(sweep.points[1].y_m, 5);
    EXPECT_LE(sweep.header.begin, sweep.header.stamp);
    EXPECT_LE(sweep.header.stamp, sweep.header.end);
    for (const LidarPoint& p : sweep.points) {
      EXPECT_LE(sweep.header.begin + Duration::from_ns(p.offset_ns), sweep.header.end);
    }
  }
}

TEST_P(ReplayFolder, EndsForGood) {
  layout_->good_scan(0);
  layout_->times({1});
  const auto source = must_open(layout_->path());
  EXPECT_EQ(read_all(*source).size(), 1U);
  EXPECT_EQ(read_all(*source).size(), 0U);
}

TEST_P(ReplayFolder, TruncatedFileIsReadToItsLastWholePoint) {
  layout_->good_scan(0);
  layout_->times({1});
  const auto whole = read_bytes(layout_->file(0));
  const std::size_t point_bytes = layout_->point_floats() * sizeof(float);
  for (std::size_t bytes = 0; bytes <= whole.size(); ++bytes) {
    write_bytes(layout_->file(0), std::span(whole).first(bytes));
    const auto sweeps = read();
    EXPECT_EQ(sweeps.empty() ? 0 : sweeps[0].points.size(), bytes / point_bytes);
    EXPECT_EQ(rejected_.contains("truncated_file"), bytes % point_bytes != 0) << bytes;
    EXPECT_EQ(rejected_.contains("empty_sweep"), bytes < point_bytes) << bytes;
  }
}

TEST_P(ReplayFolder, PointsThatAreNoPointsAreDroppedAndCounted) {
  layout_->scan(0, {{kNaN, 2, 3, 0},
                    {1, kInf, 3, 0},
                    {1, 2, -kInf, 0},
                    {1, 2, 3, kNaN},
                    {kInf, -kInf, 3, 0},
                    {0, 0, 0, 0.5F},
                    {1, 2, 3, 0.25F}});
  layout_->times({1});
  const auto sweeps = read();
  ASSERT_EQ(sweeps.size(), 1U);
  ASSERT_EQ(sweeps[0].points.size(), 1U);
  EXPECT_EQ(sweeps[0].points[0].intensity, 0.25F);
  EXPECT_EQ(rejected_, (Counts{{"non_finite_point", 5}, {"no_return", 1}}));
}

TEST_P(ReplayFolder, EmptySweepIsPassedOverAndOnePointIsASweep) {
  layout_->scan(0, {});
  layout_->scan(1, {{0, 0, 0, 0}, {0, 0, 0, 0}});
  layout_->scan(2, {{1, 2, 3, 0}});
  layout_->times({1, 1.1, 1.2});
  const auto sweeps = read();
  EXPECT_EQ(numbers(sweeps), (Numbers{2}));
  EXPECT_EQ(rejected_, (Counts{{"empty_sweep", 2}, {"no_return", 2}}));
}

TEST_P(ReplayFolder, PointsAboveCapacityAreCountedOneByOne) {
  layout_->good_scan(0);
  layout_->times({1});
  const auto sweeps = read(2);
  ASSERT_EQ(sweeps.size(), 1U);
  EXPECT_EQ(sweeps[0].points.size(), 2U);
  EXPECT_EQ(rejected_, (Counts{{"above_capacity", 1}}));
}

TEST_P(ReplayFolder, RepeatedBackwardAndMissingTimesPassTheirSweepsOver) {
  for (int i = 0; i < 7; ++i) layout_->good_scan(i);
  layout_->times({1, 1.1, 1.1, 1.05, -1, 1.3});
  EXPECT_EQ(numbers(read()), (Numbers{0, 1, 5}));
  EXPECT_EQ(rejected_, (Counts{{"time_repeated", 1}, {"time_backwards", 1}, {"time_missing", 2}}));
}

TEST_P(ReplayFolder, MissingFilesAreCountedAndTheOthersKeepTheirTimes) {
  layout_->good_scan(0);
  layout_->good_scan(3);
  layout_->times({1, 1.1, 1.2, 1.3, 1.4});
  const auto sweeps = read();
  ASSERT_EQ(numbers(sweeps), (Numbers{0, 3}));
  EXPECT_EQ((sweeps[1].header.begin - sweeps[0].header.begin).ns(), 300'000'000);
  EXPECT_EQ(rejected_, (Counts{{"missing_file", 3}}));
}

TEST_P(ReplayFolder, FileThatCannotBeReadIsPassedOver) {
  layout_->good_scan(0);
  layout_->good_scan(1);
  layout_->times({1, 1.1});
  const auto source = must_open(layout_->path());
  std::filesystem::remove(layout_->file(0));
  EXPECT_EQ(numbers(read_all(*source)), (Numbers{1}));
  EXPECT_EQ(source->rejected(), (Counts{{"unreadable_file", 1}}));
}

TEST_P(ReplayFolder, FolderInPlaceOfAScanFileIsPassedOver) {
  std::filesystem::create_directories(layout_->file(0));
  layout_->good_scan(1);
  layout_->times({1, 1.1});
  EXPECT_EQ(numbers(read()), (Numbers{1}));
  EXPECT_EQ(rejected_, (Counts{{"unreadable_file", 1}}));
}

TEST_P(ReplayFolder, OtherFilesBesideTheScansAreIgnored) {
  layout_->good_scan(0);
  write_text(layout_->file(0).parent_path() / "notes.bin", "x");
  write_text(layout_->file(0).parent_path() / "000001.bak", "x");
  layout_->times({1});
  EXPECT_EQ(numbers(read()), (Numbers{0}));
  EXPECT_TRUE(rejected_.empty());
}

TEST_P(ReplayFolder, UnreadableTimesLineNamesFileAndLine) {
  layout_->good_scan(0);
  layout_->times({1, 1.1});
  write_text(layout_->times_file(), "yesterday\n");
  const std::string message = open_error(layout_->path());
  EXPECT_NE(message.find(layout_->times_file().string() + ": line 1: found \"yesterday\", wanted"), std::string::npos)
      << message;
}

TEST_P(ReplayFolder, MissingTimesFileIsNamed) {
  layout_->good_scan(0);
  layout_->times({1});
  std::filesystem::remove(layout_->times_file());
  const std::string message = open_error(layout_->path());
  EXPECT_NE(message.find(layout_->times_file().string() + ": cannot be read"), std::string::npos) << message;
}

TEST_P(ReplayFolder, NoScansAtAllIsAnError) {
  layout_->good_scan(0);
  layout_->times({1});
  std::filesystem::remove(layout_->file(0));
  EXPECT_NE(open_error(layout_->path()).find("found no scan file, wanted 000000.bin"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ReplayFolder, testing::ValuesIn(every_layout()),
                         [](const auto& param) { return letters_of(param.param.kind); });

}  // namespace
}  // namespace lxd::source_folder_test
