// SPDX-License-Identifier: Apache-2.0
// report.json has the shape that the scripts that read it were promised.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "board/report.hpp"

namespace lxd::board_report_test {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys_of(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

Report sample() {
  Report report;
  report.sweeps = 154;
  report.duration_s = 15.9;
  report.real_time_factor = 3.5;
  report.threads = 2;
  report.sweep_ms = {30, 29, 45, 50};
  report.stages_ms["deskew"] = {1, 2, 3, 4};
  report.dropped["late"] = 2;
  report.rejected["kitti-raw"]["truncated_file"] = 1;
  report.degraded.push_back({"LI", "L", 12.5});
  report.rt_allocations = 0;
  report.pools["sweeps"] = {4, 3};
  report.back_end.loops_proposed = 5;
  return report;
}

TEST(BoardReport, NamesLossesAndNothingElse) {
  EXPECT_EQ(losses_text(sample()), "kitti-raw: truncated_file 1; dropped: late 2");
  Report rejected;
  rejected.rejected["rig-recording"] = {{"no_return", 7}, {"stale_packet", 3}};
  EXPECT_EQ(losses_text(rejected), "rig-recording: no_return 7, stale_packet 3");
  EXPECT_EQ(losses_text(Report{}), "nothing rejected, nothing dropped");
}

TEST(BoardReport, ASurprisedFilterIsAHint) {
  Report sound, lost, still;
  sound.updates.nis = 60;
  sound.updates.nis_dimensions = 10;
  lost.updates.nis = 160;
  lost.updates.nis_dimensions = 10;
  for (Report* const report : {&sound, &lost, &still}) add_surprise(*report);
  EXPECT_TRUE(sound.hints.empty());
  EXPECT_TRUE(still.hints.empty());
  ASSERT_EQ(lost.hints.size(), 1U);
  EXPECT_NE(lost.hints[0].find("16 times"), std::string::npos) << lost.hints[0];
}

TEST(BoardReport, HasThePromisedKeysInThePromisedOrder) {
  const Json json = Json::parse(report_json(Report{}));
  const std::vector<std::string> promised = {"sweeps",
                                             "duration_s",
                                             "real_time_factor",
                                             "threads",
                                             "sweep_ms",
                                             "stages_ms",
                                             "dropped",
                                             "rejected",
                                             "degraded",
                                             "hints",
                                             "updates",
                                             "interrupted",
                                             "rt_allocations",
                                             "rt_page_faults",
                                             "peak_rss_mib",
                                             "pools",
                                             "loops",
                                             "graph",
                                             "gnss",
                                             "map"};
  EXPECT_EQ(keys_of(json), promised);
  EXPECT_EQ(keys_of(json["sweep_ms"]), (std::vector<std::string>{"mean", "p50", "p99", "max"}));
  EXPECT_EQ(keys_of(json["loops"]), (std::vector<std::string>{"proposed", "accepted", "found"}));
}

TEST(BoardReport, NamesEveryStageEvenThoseThatDidNotRun) {
  const Json stages = Json::parse(report_json(sample()))["stages_ms"];
  const std::vector<std::string> promised = {"predict", "deskew",        "downsample", "lidar_update",
                                             "raycast", "visual_update", "meshing",    "rotation_guess"};
  EXPECT_EQ(keys_of(stages), promised);
  EXPECT_EQ(stages["deskew"]["p99"], 3.0);
  EXPECT_EQ(stages["visual_update"]["max"], 0.0);
}

TEST(BoardReport, KeepsEmptyTablesAsObjectsAndLists) {
  const Json json = Json::parse(report_json(Report{}));
  for (const char* table : {"dropped", "rejected", "pools"}) EXPECT_TRUE(json[table].is_object()) << table;
  EXPECT_TRUE(json["degraded"].is_array());
}

TEST(BoardReport, TellsCountsByCause) {
  const Json json = Json::parse(report_json(sample()));
  EXPECT_EQ(json["dropped"]["late"], 2);
  EXPECT_EQ(json["rejected"]["kitti-raw"]["truncated_file"], 1);
  EXPECT_EQ(json["degraded"][0], (Json{{"from", "LI"}, {"to", "L"}, {"t", 12.5}}));
  EXPECT_EQ(json["pools"]["sweeps"], (Json{{"capacity", 4}, {"high_water", 3}}));
}

// Given a loop by sight that the graph did not believe, then it is told with what it said; the search's counts only
// where there was one.
TEST(BoardReport, TellsLoopsAndWhatFoundThem) {
  Report report;
  EXPECT_FALSE(Json::parse(report_json(report))["loops"].contains("by_sight"));
  ClosedLoop loop{RigTime::from_seconds(10), RigTime::from_seconds(70), {}, false};
  loop.measured.by = LoopSense::sight;
  loop.measured.T_from_to.p = {0.5, 0, 0};
  loop.measured.covariance.diagonal() << 0, 0, 0, 0.01, 0.04, 0.01;
  report.loops.push_back(loop);
  report.sight.emplace().verified = {{"accepted", 1}, {"few_inliers", 2}};
  const Json loops = Json::parse(report_json(report))["loops"];
  EXPECT_EQ(loops["found"][0]["by"], "sight");
  EXPECT_EQ(loops["found"][0]["to_t"], 70.0);
  EXPECT_EQ(loops["found"][0]["accepted"], false);
  EXPECT_EQ(loops["found"][0]["T_from_to"], (Json{0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(loops["found"][0]["sigma_m"], 0.2);
  EXPECT_EQ(loops["by_sight"]["verified"]["few_inliers"], 2);
}

TEST(BoardReport, TellsTheNisOfAllUpdatesPerDimensionOnceThereWasOne) {
  Report report;
  EXPECT_TRUE(Json::parse(report_json(report))["updates"]["nis_per_dimension"].is_null());
  report.updates.nis = 30;
  report.updates.nis_dimensions = 24;
  EXPECT_EQ(Json::parse(report_json(report))["updates"]["nis_per_dimension"], 1.25);
}

TEST(BoardReport, DoesNotClaimZeroAllocationsThatItCouldNotCount) {
  EXPECT_EQ(Json::parse(report_json(sample()))["rt_allocations"], 0);
  EXPECT_TRUE(Json::parse(report_json(Report{}))["rt_allocations"].is_null());
}

TEST(BoardReport, PeakMemoryIsThatOfAProgramThatRuns) {
  EXPECT_GT(peak_rss_mib(), 1);
  EXPECT_LT(peak_rss_mib(), 1e5);
}

TEST(BoardReport, TellsACamerasMountAboutTheReferencesAxes) {
  Report report;
  EXPECT_FALSE(Json::parse(report_json(report)).contains("camera_mount"));
  report.camera_mount = MountReport{{0.5, -1, 0}, {0.1, 0.1, 0.4}};
  const Json mount = Json::parse(report_json(report))["camera_mount"];
  EXPECT_EQ(mount["turned_deg"][1], -1);
  EXPECT_EQ(mount["sigma_deg"][2], 0.4);
}

}  // namespace
}  // namespace lxd::board_report_test
