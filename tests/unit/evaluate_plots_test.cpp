// SPDX-License-Identifier: Apache-2.0
// Plots are pictures of the right size with something in them, whatever is known and however broken it is; their
// numbers are round and lie where they should.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/picture.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/plots/error_plots.hpp"
#include "tools/evaluate/plots/plot_scale.hpp"
#include "tools/evaluate/plots/plot_sheet.hpp"
#include "tools/evaluate/plots/sensor_plots.hpp"

namespace lxd::evaluate_plots_test {
namespace {

using test::Picture;
using test::read_png;
using test::TemporaryFolder;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> texts(const std::vector<Tick>& ticks) {
  std::vector<std::string> all;
  for (const Tick& tick : ticks) all.push_back(tick.text);
  return all;
}

using Texts = std::vector<std::string>;

TEST(PlotScale, NumbersAreRoundAndWithin) {
  EXPECT_EQ(texts(PlotScale({0, 10}, 0, 100).ticks(5)), (Texts{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(texts(PlotScale({-0.13, 0.13}, 0, 100).ticks(3)), (Texts{"-0.1", "0.0", "0.1"}));
  EXPECT_EQ(texts(PlotScale({3.1, 3.9}, 0, 100).ticks(4)), (Texts{"3.2", "3.4", "3.6", "3.8"}));
  EXPECT_EQ(texts(PlotScale({0, 1e5}, 0, 100).ticks(2)), (Texts{"0", "50000", "100000"}));
  EXPECT_EQ(texts(PlotScale({0.05, 200}, 0, 100, ScaleKind::logarithmic).ticks(9)), (Texts{"0.1", "1", "10", "100"}));
}

TEST(PlotScale, PixelsFollowTheValues) {
  const PlotScale linear({-1, 1}, 200, 100);
  EXPECT_DOUBLE_EQ(linear.pixel(-1), 200);
  EXPECT_DOUBLE_EQ(linear.pixel(0), 150);
  const PlotScale logarithmic({1, 100}, 0, 100, ScaleKind::logarithmic);
  EXPECT_NEAR(logarithmic.pixel(10), 50, 1e-9);
  EXPECT_DOUBLE_EQ(logarithmic.pixel(-3), 0);
}

TEST(PlotScale, NothingAndOneValueStillHaveAScale) {
  for (const Interval values : {Interval{5, 5}, Interval{kNan, 1}, Interval{0, INFINITY}}) {
    const PlotScale scale(values, 0, 100);
    EXPECT_TRUE(std::isfinite(scale.pixel(5)));
    EXPECT_FALSE(scale.ticks(4).empty());
  }
  EXPECT_EQ(covering({}).high, 1);
  EXPECT_EQ(covering({kNan, 2, 4}, 0).low, 2);
}

// Everything that `evaluate` may know of a run of `poses` poses.
EvaluationReport sample(int poses) {
  EvaluationReport r;
  r.matched = static_cast<std::size_t>(poses);
  r.duration_s = 0.1 * poses;
  r.truth_path_m = 0.1 * poses;
  for (int i = 0; i < poses; ++i) {
    PoseErrors& e = r.poses.emplace_back();
    e.t_s = 0.1 * i;
    e.way_m = 0.1 * i;
    e.position_m = 0.02 + 0.01 * std::sin(0.1 * i);
    e.turn_rad = 0.002;
    e.since_start.setConstant(0.01 * std::sin(0.2 * i));
    e.sigma.setConstant(0.002 + 1e-5 * i);
    e.nees = 6 + 5 * std::sin(0.3 * i);
    r.innovations.push_back({0.1 * i, 12 + 6 * std::sin(0.4 * i), 12});
  }
  r.orientation_rad.emplace();
  r.kitti = KittiErrors{{{1, 20, 0.01, 0.001}, {2, 18, 0.008, 0.0007}}, 0.009, 0.0008};
  r.consistency.emplace();
  r.innovation.emplace().dimensions_mean = 12;
  r.mesh.emplace();
  for (int i = 0; i < 1000; ++i) r.mesh->distances_m.push_back(1e-5 * i);
  r.mesh->calibration =
      MeshCalibration{1000, 0, 1, 0.45, 1, {0.68, 0.95, 0.99}, {{500, 0.01, 0.012}, {500, 0.02, 0.018}}};
  return r;
}

class ErrorPlots : public ::testing::Test {
 protected:
  Picture draw(const EvaluationReport& report) {
    const Status written = write_error_plots(folder_ / "errors.png", report, "run / odometry.tum");
    EXPECT_TRUE(written.ok());
    return read_png(folder_ / "errors.png");
  }
  static void expect_rows(const Picture& picture, int rows) {
    EXPECT_EQ(picture.width, PlotSheet::kWidth_px);
    EXPECT_EQ((picture.height - PlotSheet::kTitle_px) / PlotSheet::kRow_px, rows);
    EXPECT_GT(picture.colours, 60U);
  }
  TemporaryFolder folder_;
};

TEST_F(ErrorPlots, ShowEverythingThatIsKnown) { expect_rows(draw(sample(300)), 7); }

TEST_F(ErrorPlots, LeaveOutWhatIsNotKnown) {
  EvaluationReport prism = sample(50);
  prism.orientation_rad.reset();
  prism.kitti.reset();
  prism.consistency.reset();
  prism.innovation.reset();
  prism.mesh.reset();
  for (PoseErrors& e : prism.poses) e.turn_rad = kNan;
  expect_rows(draw(prism), 1);
}

TEST_F(ErrorPlots, StandBrokenNumbersAndNoPoses) {
  EvaluationReport broken = sample(50);
  broken.poses[3].since_start.setConstant(INFINITY);
  broken.poses[7].nees = -1;
  broken.poses[9].sigma.setConstant(kNan);
  broken.innovations[4].nis = 0;
  broken.mesh->distances_m.assign(10, 0.0);
  broken.mesh->calibration.reset();
  expect_rows(draw(broken), 7);
  EvaluationReport empty = sample(0);
  empty.mesh->distances_m.clear();
  expect_rows(draw(empty), 7);
}

TEST_F(ErrorPlots, AreNotWrittenWhereThereIsNoFolder) {
  const Status written = write_error_plots(folder_ / "none" / "errors.png", sample(10), "title");
  ASSERT_FALSE(written.ok());
  EXPECT_NE(written.error().message.find("errors.png"), std::string::npos);
}

TEST_F(ErrorPlots, AreTheSameEachTime) {
  draw(sample(100));
  const std::string first = test::read_file(folder_ / "errors.png");
  draw(sample(100));
  EXPECT_EQ(test::read_file(folder_ / "errors.png"), first);
}

TimeSeries wave(const std::string& name, int samples, double phase) {
  TimeSeries series{name, {}, {}};
  for (int i = 0; i < samples; ++i) {
    series.t_s.push_back(0.005 * i);
    series.values.push_back(std::sin(0.03 * i + phase));
  }
  return series;
}

class SensorPlots : public ErrorPlots {
 protected:
  Status write(const std::vector<SensorPanel>& panels) {
    return write_sensor_plots(folder_ / "sensors.png", panels, "recording", "10 s");
  }
};

TEST_F(SensorPlots, HaveAPanelForEachOfThem) {
  using Kind = SensorPanel::Kind;
  const std::vector<SensorPanel> panels{{Kind::curves, "rates", "rad/s", {wave("x", 20'000, 0), wave("y", 20'000, 1)}},
                                        {Kind::dots, "fix", "", {wave("quality", 50, 0)}},
                                        {Kind::histogram, "interval", "ms", {wave("imu", 500, 0)}}};
  ASSERT_TRUE(write(panels).ok());
  expect_rows(read_png(folder_ / "sensors.png"), 2);
}

TEST_F(SensorPlots, StandSilentAndBrokenSensors) {
  using Kind = SensorPanel::Kind;
  const TimeSeries broken{"broken", {0, 1, 2}, {kNan, INFINITY, kNan}}, same{"same", {0, 1, 2}, {5, 5, 5}};
  std::vector<SensorPanel> panels;
  for (const Kind kind : {Kind::curves, Kind::dots, Kind::histogram})
    for (const auto& series : {std::vector<TimeSeries>{}, {TimeSeries{"none", {}, {}}}, {broken}, {same}})
      panels.push_back({kind, "panel", "unit", series});
  ASSERT_TRUE(write(panels).ok());
  expect_rows(read_png(folder_ / "sensors.png"), 6);
}

TEST_F(SensorPlots, RefuseNoPanelTooManyAndNoFolder) {
  EXPECT_FALSE(write({}).ok());
  EXPECT_FALSE(write(std::vector<SensorPanel>(10'000)).ok());
  const std::vector<SensorPanel> one(1);
  EXPECT_FALSE(write_sensor_plots(folder_ / "none" / "sensors.png", one, "", "").ok());
}

TEST(SensorSeries, IntervalsAndLatenciesAreInMilliseconds) {
  const auto at = [](std::int64_t ms) { return RigTime::from_ns(ms * 1'000'000); };
  const std::vector<RigTime> taken{at(100), at(105), at(115)}, received{at(102), at(108), at(116)};
  const TimeSeries intervals = intervals_ms("imu", taken, at(100));
  EXPECT_EQ(intervals.values, (std::vector<double>{5, 10}));
  ASSERT_EQ(intervals.t_s.size(), 2U);
  EXPECT_NEAR(intervals.t_s[1], 0.015, 1e-12);
  EXPECT_EQ(latency_ms("imu", taken, received, at(100)).values, (std::vector<double>{2, 3, 1}));
  EXPECT_TRUE(intervals_ms("none", {}, at(0)).values.empty());
}

}  // namespace
}  // namespace lxd::evaluate_plots_test
