// SPDX-License-Identifier: Apache-2.0
// Ouster captures with one turn damaged, through the whole program: the run goes on, the report counts what was
// rejected, and what came before and after the damage is mapped.
#include "tests/support/run_result.hpp"
#include "tests/support/standing_capture.hpp"

namespace lxd::test::damaged_capture_test {
namespace {

constexpr int kTurns = 6, kDamaged = 3;
constexpr int kFailed = 1, kBadInput = 2;

struct Damage {
  const char* name;
  void (*apply)(StandingCapture& capture);
  const char* cause;  // of the one rejection; empty: the filter's
  std::size_t count;
  bool lost = true;  // the turn gives no pose
};

void make_zero(StandingCapture& capture) { capture.set_ranges(capture.turn(kDamaged), 0); }

void make_one_point(StandingCapture& capture) {
  make_zero(capture);
  capture.set_range(capture.turn(kDamaged)[5].data() + capture.metadata().format.column_offset(3), 7, 5000);
}

void repeat_time(StandingCapture& capture) {
  capture.shift_time(capture.turn(kDamaged), -std::int64_t{StandingCapture::kTurn_ns});
}
void turn_time_back(StandingCapture& capture) {
  capture.shift_time(capture.turn(kDamaged), -2 * std::int64_t{StandingCapture::kTurn_ns});
}
void lose_turn(StandingCapture& capture) { capture.turn(kDamaged).clear(); }
void cut_packets(StandingCapture& capture) {
  for (std::size_t i = 0; i < 8; ++i) capture.turn(kDamaged)[i].resize(capture.turn(kDamaged)[i].size() / 2);
}
void repeat_packets(StandingCapture& capture) {
  auto& turn = capture.turn(kDamaged);
  const StandingCapture::Turn twice(turn.begin(), turn.begin() + 2);
  turn.insert(turn.begin() + 10, twice.begin(), twice.end());
}

const Damage kDamages[] = {
    {"AllZeroRanges", make_zero, "empty_sweep", 1},
    {"OnePoint", make_one_point, "", 1},
    {"RepeatedTime", repeat_time, "time_repeated", 1},
    {"TimeRunsBackwards", turn_time_back, "time_backwards", 1},
    {"LostTurn", lose_turn, "missing_frame", 1},
    {"TruncatedPackets", cut_packets, "bad_size", 8, false},
    {"RepeatedPackets", repeat_packets, "repeated_column", 32, false},
};

class DamagedCapture : public testing::TestWithParam<Damage> {};

void expect_path_around(const RunResult& run, bool lost) {
  const auto path = run.path();
  ASSERT_EQ(path.size(), static_cast<std::size_t>(lost ? kTurns - 1 : kTurns));
  for (std::size_t i = 0; i < path.size(); ++i) {
    const int turn = static_cast<int>(i) + (lost && i >= kDamaged ? 1 : 0);
    EXPECT_NEAR((path[i].stamp - path[0].stamp).seconds(), 0.1 * turn, 0.02);
    EXPECT_LT(path[i].T.p.norm(), 0.05) << "turn " << turn;
  }
}

TEST_P(DamagedCapture, IsCountedAndTheRestIsMapped) {
  StandingCapture capture(kTurns);
  GetParam().apply(capture);
  const TemporaryFolder folder;
  const RunResult run = replayed(capture.write(), folder, "");
  const auto report = run.report();
  if (*GetParam().cause == '\0') {
    EXPECT_EQ(report["dropped"], nlohmann::json({{"too_few_points", 1}}));
  } else {
    EXPECT_EQ(report["rejected"]["ouster-pcap"].value(GetParam().cause, std::size_t{0}), GetParam().count) << report;
  }
  expect_path_around(run, GetParam().lost);
  EXPECT_GT(run.faces(), 5000U);
}

INSTANTIATE_TEST_SUITE_P(Turn, DamagedCapture, testing::ValuesIn(kDamages),
                         [](const auto& damage) { return damage.param.name; });

TEST(TruncatedCapture, IsMappedAsFarAsItGoes) {
  const StandingCapture capture(kTurns);
  const auto pcap = capture.write();
  std::filesystem::resize_file(pcap, std::filesystem::file_size(pcap) * 7 / 12 + 100);  // half of the fourth turn
  const TemporaryFolder folder;
  const RunResult run = replayed(pcap, folder, "");
  EXPECT_EQ(run.report()["rejected"]["ouster-pcap"]["truncated_file"], 1);
  EXPECT_EQ(run.path().size(), 4U);
  EXPECT_GT(run.faces(), 5000U);
}

class RefusedCapture : public testing::Test {
 protected:
  void expect_ends(int status, const std::vector<std::string>& said) const {
    const TemporaryFolder folder;
    const Ended ended =
        lxd_slam(fmt::format("replay {} --out {}", capture_.pcap().string(), (folder / "run").string()));
    EXPECT_EQ(ended.status, status) << ended.text;
    for (const std::string& part : said) EXPECT_TRUE(ended.says(part)) << "wanted: " << part << "\n" << ended.text;
    EXPECT_EQ(std::filesystem::exists(folder / "run"), status == kFailed);
  }

  StandingCapture capture_{1};
};

TEST_F(RefusedCapture, WithoutMetadataSaysWhichFileIsWanted) {
  capture_.write();
  std::filesystem::remove(capture_.json());
  expect_ends(kBadInput, {"drive.pcap: found 0 .json files", "drive.json"});
}

TEST_F(RefusedCapture, WithDamagedMetadataNamesFileAndKey) {
  capture_.write();
  write_file(capture_.json(), R"({"lidar_mode": "1024x10"})");
  expect_ends(kBadInput, {"drive.json: beam_altitude_angles: found nothing"});
  write_file(capture_.json(), "{");
  expect_ends(kBadInput, {"drive.json"});
  write_file(capture_.json(), "");
  expect_ends(kBadInput, {"drive.json"});
}

TEST_F(RefusedCapture, CutWithinItsHeadIsNoCapture) {
  capture_.write();
  std::filesystem::resize_file(capture_.pcap(), 10);
  expect_ends(kBadInput, {"drive.pcap: no readable packet capture"});
}

TEST_F(RefusedCapture, WithoutAnyPacketFails) {
  capture_.write();
  std::filesystem::resize_file(capture_.pcap(), 24);
  expect_ends(kFailed, {"drive.pcap: found no sweep that could be used"});
}

TEST_F(RefusedCapture, WithAnotherSensorsMetadataFailsAndSaysWhy) {
  capture_.write();
  std::filesystem::copy_file(replay_test::clone_ouster() / "windowed_frame1_0.json", capture_.json(),
                             std::filesystem::copy_options::overwrite_existing);
  expect_ends(kFailed, {"drive.pcap: found no sweep that could be used", "bad_size 64"});
}

}  // namespace
}  // namespace lxd::test::damaged_capture_test
