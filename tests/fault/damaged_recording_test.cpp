// SPDX-License-Identifier: Apache-2.0
// Folder recordings of every kind with one sweep damaged, through the whole program: the run goes on, the report counts
// what was rejected, and what came before and after the damage is mapped.
#include <limits>

#include "board/default/capacities.hpp"
#include "tests/support/replay_layouts.hpp"
#include "tests/support/room_scan.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::damaged_recording_test {
namespace {

using replay_test::LayoutCase;
using replay_test::ReplayLayout;

constexpr int kSweeps = 7, kDamaged = 3;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

std::vector<double> sound_times() {
  std::vector<double> times;
  for (int i = 0; i < kSweeps; ++i) times.push_back(10 + 0.1 * i);
  return times;
}

void set_time(ReplayLayout& layout, double time_s) {
  std::vector<double> times = sound_times();
  times[kDamaged] = time_s;
  layout.times(times);
}

struct Damage {
  const char* name;
  void (*apply)(ReplayLayout& layout);
  nlohmann::json rejected;  // by the reader: cause and count
  nlohmann::json dropped;   // by the filter
  bool lost = true;         // the sweep gives no pose
};

void cut_short(ReplayLayout& layout) {
  const auto bytes = std::filesystem::file_size(layout.file(kDamaged));
  std::filesystem::resize_file(layout.file(kDamaged), bytes / 2 + 5);  // half a turn, and a bit of a point
}

void mix_with_nonsense(ReplayLayout& layout) {
  auto points = room_scan();
  points[0] = {kNaN, 1, 1, 1};
  points[100] = {1, kInf, 1, 1};
  points[200] = {1, 1, -kInf, kNaN};
  layout.scan(kDamaged, points);
}

void fill_with_nonsense(ReplayLayout& layout) {
  layout.scan(kDamaged, std::vector<std::array<float, 4>>(1000, {kNaN, kInf, kNaN, kNaN}));
}

void make_empty(ReplayLayout& layout) { layout.scan(kDamaged, {}); }

void make_zero(ReplayLayout& layout) { layout.scan(kDamaged, std::vector<std::array<float, 4>>(1000, {0, 0, 0, 0})); }

void make_one_point(ReplayLayout& layout) { layout.scan(kDamaged, {{3, 1, 0, 1}}); }

// The room's points over and over: what fits is a sound sweep.
void overfill(ReplayLayout& layout) {
  auto points = room_scan();
  const std::size_t once = points.size();
  while (points.size() < capacities::kSweepPointsMax + 10) points.push_back(points[points.size() - once]);
  layout.scan(kDamaged, points);
}

void make_folder_of_it(ReplayLayout& layout) {
  std::filesystem::remove(layout.file(kDamaged));
  std::filesystem::create_directory(layout.file(kDamaged));
}

void remove_file(ReplayLayout& layout) { std::filesystem::remove(layout.file(kDamaged)); }
void remove_time(ReplayLayout& layout) { set_time(layout, -1); }
void repeat_time(ReplayLayout& layout) { set_time(layout, 10.2); }
void turn_time_back(ReplayLayout& layout) { set_time(layout, 10.05); }

const Damage kDamages[] = {
    {"TruncatedFile", cut_short, {{"truncated_file", 1}}, nlohmann::json::object(), false},
    {"NanAndInfinitePoints", mix_with_nonsense, {{"non_finite_point", 3}}, nlohmann::json::object(), false},
    {"NothingButNan", fill_with_nonsense, {{"non_finite_point", 1000}, {"empty_sweep", 1}}, nlohmann::json::object()},
    {"EmptySweep", make_empty, {{"empty_sweep", 1}}, nlohmann::json::object()},
    {"AllZeroRanges", make_zero, {{"no_return", 1000}, {"empty_sweep", 1}}, nlohmann::json::object()},
    {"OnePoint", make_one_point, nlohmann::json::object(), {{"too_few_points", 1}}},
    {"AboveCapacity", overfill, {{"above_capacity", 10}}, nlohmann::json::object(), false},
    {"UnreadableFile", make_folder_of_it, {{"unreadable_file", 1}}, nlohmann::json::object()},
    {"MissingFile", remove_file, {{"missing_file", 1}}, nlohmann::json::object()},
    {"MissingTime", remove_time, {{"time_missing", 1}}, nlohmann::json::object()},
    {"RepeatedTime", repeat_time, {{"time_repeated", 1}}, nlohmann::json::object()},
    {"TimeRunsBackwards", turn_time_back, {{"time_backwards", 1}}, nlohmann::json::object()},
};

class DamagedRecording : public testing::TestWithParam<std::tuple<LayoutCase, Damage>> {
 protected:
  void SetUp() override {
    layout_ = std::get<0>(GetParam()).make();
    for (int i = 0; i < kSweeps; ++i) layout_->scan(i, room_scan());
    layout_->times(sound_times());
  }

  std::unique_ptr<ReplayLayout> layout_;
};

// Poses of the standing LiDAR; with its times by the recording's grid: every sweep but perhaps the damaged one.
void expect_path_around(const RunResult& run, bool lost) {
  const auto path = run.path();
  ASSERT_EQ(path.size(), static_cast<std::size_t>(lost ? kSweeps - 1 : kSweeps));
  for (std::size_t i = 0; i < path.size(); ++i) {
    const int sweep = static_cast<int>(i) + (lost && i >= kDamaged ? 1 : 0);
    EXPECT_NEAR((path[i].stamp - path[0].stamp).seconds(), 0.1 * sweep, 0.05);  // half a turn has half the time
    EXPECT_LT(path[i].T.p.norm(), 0.02) << "sweep " << sweep;
  }
  EXPECT_EQ(run.path("trajectory.tum").size(), path.size());
}

TEST_P(DamagedRecording, IsCountedAndTheRestIsMapped) {
  const auto& [kind, damage] = GetParam();
  damage.apply(*layout_);
  const TemporaryFolder folder;
  const RunResult run = replayed(layout_->path(), folder, "");
  const auto report = run.report();
  EXPECT_EQ(report["rejected"].value(kind.kind, nlohmann::json::object()), damage.rejected);
  EXPECT_EQ(report["dropped"], damage.dropped);
  expect_path_around(run, damage.lost);
  EXPECT_GT(run.faces(), 1000U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, DamagedRecording,
                         testing::Combine(testing::ValuesIn(replay_test::every_layout()), testing::ValuesIn(kDamages)),
                         [](const auto& param) {
                           return replay_test::letters_of(std::get<0>(param.param).kind) + "_" +
                                  std::get<1>(param.param).name;
                         });

}  // namespace
}  // namespace lxd::test::damaged_recording_test
