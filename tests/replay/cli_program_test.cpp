// SPDX-License-Identifier: Apache-2.0
// The program as its callers see it: what it prints, and with which status it ends.
#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::cli_program_test {
namespace {

namespace fs = std::filesystem;

using test::Ended;
using test::lxd_slam;

bool says(const Ended& ended, const std::string& part) { return ended.says(part); }

class Cli : public testing::Test {
 protected:
  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return path(name);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // Four walls and a floor around a LiDAR that stands still: the smallest recording with a map in it.
  [[nodiscard]] std::string record_room(int sweeps) const {
    fs::create_directories(folder_ / "room" / "lidar0");
    std::ofstream times(folder_ / "room" / "lidar0" / "times.txt");
    for (int i = 0; i < sweeps; ++i) {
      std::ofstream bin(folder_ / "room" / "lidar0" / (std::to_string(1'000'000 + i).substr(1) + ".bin"),
                        std::ios::binary);
      write_sweep(bin);
      times << 100 + i * 0.1 << "\n";
    }
    (void)write("room/rig.yaml",
                "reference: lidar0\nlidar0: {beams: 16, columns: 512, rate_hz: 10, range_m: [0.3, 50]}\n");
    return path("room");
  }

  static void write_sweep(std::ostream& bin) {
    constexpr int kColumns = 512, kBeams = 16;
    constexpr float kHalf_m = 4.0F, kPi = 3.14159265F;
    for (int c = 0; c < kColumns; ++c) {
      const float azimuth = 2 * kPi * static_cast<float>(c) / kColumns;
      const float reach = kHalf_m / std::max(std::abs(std::cos(azimuth)), std::abs(std::sin(azimuth)));
      for (int b = 0; b < kBeams; ++b) {
        const float slope = -0.4F + 0.05F * static_cast<float>(b);
        const float shortened = slope < 0 ? std::min(reach, -1.2F / slope) : reach;  // the floor is 1.2 m below
        const std::array<float, 5> point{shortened * std::cos(azimuth), shortened * std::sin(azimuth),
                                         shortened * slope, 1, 0.1F * static_cast<float>(c) / kColumns};
        bin.write(reinterpret_cast<const char*>(point.data()), sizeof point);
      }
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(Cli, HelpNamesTheCommands) {
  const Ended ended = lxd_slam("--help");
  EXPECT_EQ(ended.status, 0);
  for (const char* name :
       {"run", "record", "replay", "evaluate", "export", "check", "budget", "doctor", "simulate", "import"})
    EXPECT_TRUE(says(ended, name)) << name;
}

TEST_F(Cli, AnUnknownCommandIsBadUsageAndListsWhatThereIs) {
  const Ended ended = lxd_slam("nonsense");
  EXPECT_EQ(ended.status, 2);
  EXPECT_TRUE(says(ended, "'nonsense'")) << ended.text;
  EXPECT_TRUE(says(ended, "run, record, replay, evaluate, export, check, budget, doctor, simulate, import"))
      << ended.text;
}

TEST_F(Cli, NoCommandAndUnknownOptionsAreBadUsage) {
  for (const char* arguments : {"", "--nonsense", "replay", "replay x --nonsense", "check", "export x", "evaluate",
                                "export x --mesh out.stl", "budget more", "doctor more"}) {
    EXPECT_EQ(lxd_slam(arguments).status, 2) << arguments;
  }
}

TEST_F(Cli, TheDoctorNamesEverySubjectAndItsStatusSaysWhetherSomethingLacks) {
  const Ended ended = lxd_slam("doctor");
  for (const char* subject : {"kernel", "real-time priority", "locked memory", "socket buffers", "clock source"})
    EXPECT_TRUE(says(ended, subject)) << ended.text;
  EXPECT_EQ(ended.status, says(ended, "LACK") ? 1 : 0) << ended.text;
}

TEST_F(Cli, EveryCommandHasItsHelp) {
  for (const char* name : {"replay", "evaluate", "export", "check", "budget", "doctor"}) {
    EXPECT_EQ(lxd_slam(std::string(name) + " --help").status, 0) << name;
  }
  EXPECT_EQ(lxd_slam("--version").status, 0);
}

TEST_F(Cli, CheckSaysThatAGoodRigIsGood) {
  const Ended ended = lxd_slam("check " + write("rig.yaml", "reference: imu\nimu: {}\nlidar0: {}\n"));
  EXPECT_EQ(ended.status, 0);
  EXPECT_TRUE(says(ended, "good: lidar0 imu")) << ended.text;
  EXPECT_TRUE(says(ended, "identity")) << ended.text;
}

TEST_F(Cli, CheckListsEveryProblemAtOnce) {
  const Ended ended = lxd_slam("check " + write("rig.yaml", "reference: lidar0\nlidar0: {rate_hz: -1, beans: 3}\n"));
  EXPECT_EQ(ended.status, 2);
  EXPECT_TRUE(says(ended, "rig.yaml:2: lidar0.rate_hz")) << ended.text;
  EXPECT_TRUE(says(ended, "did you mean beams")) << ended.text;
  EXPECT_TRUE(says(ended, "2 problems")) << ended.text;
}

TEST_F(Cli, CheckOfAFileThatIsNotThereIsBadUsage) { EXPECT_EQ(lxd_slam("check " + path("no.yaml")).status, 2); }

TEST_F(Cli, CheckPrintsTheSettings) {
  const Ended ended = lxd_slam("check --settings");
  EXPECT_EQ(ended.status, 0);
  EXPECT_TRUE(says(ended, "mapping.cell_size_m")) << ended.text;
}

TEST_F(Cli, BudgetIsATableAndJson) {
  const Ended table = lxd_slam("budget");
  EXPECT_EQ(table.status, 0) << table.text;
  EXPECT_TRUE(says(table, "sweeps")) << table.text;
  EXPECT_TRUE(says(table, "total")) << table.text;
  const auto json = nlohmann::json::parse(lxd_slam("budget --json").text);
  EXPECT_LE(json["pools_bytes"], json["capacity_bytes"]);
  std::size_t sum = 0;
  for (const auto& pool : json["pools"]) sum += pool["bytes"].get<std::size_t>();
  EXPECT_EQ(json["pools_bytes"], sum);
  EXPECT_EQ(json["total_bytes"], sum + json["beside_bytes"].get<std::size_t>());
}

TEST_F(Cli, ReplayRefusesSensorsThatTheRigOrTheRecordingLacks) {
  const std::string room = record_room(1);
  for (const std::string sensors : {"LC", "LL", "LW", "I"}) {
    const Ended ended = lxd_slam("replay " + room + " --sensors " + sensors + " --out " + path("run"));
    EXPECT_EQ(ended.status, 2) << sensors;
    EXPECT_TRUE(says(ended, "--sensors")) << ended.text;
    EXPECT_FALSE(fs::exists(path("run"))) << sensors;
  }
}

TEST_F(Cli, ReplayRefusesABadRecordingSettingRigAndFolder) {
  const std::string room = record_room(1);
  const std::string out = " --out " + path("run");
  EXPECT_EQ(lxd_slam("replay " + path("nothing") + out).status, 2);
  EXPECT_EQ(lxd_slam("replay " + room + out + " --set nothing=1").status, 2);
  EXPECT_EQ(lxd_slam("replay " + room + out + " --rig " + path("no.yaml")).status, 2);
  EXPECT_FALSE(fs::exists(path("run")));
  EXPECT_EQ(lxd_slam("replay " + room + " --out " + room).status, 2);
  EXPECT_TRUE(fs::exists(room + "/rig.yaml"));
}

TEST_F(Cli, ReplayWritesAWholeRunWhichExportsAndReplaysAgainToTheSameBytes) {
  const std::string room = record_room(4);
  const Ended ended = lxd_slam("replay " + room + " --set threads=1 --out " + path("one"));
  ASSERT_EQ(ended.status, 0) << ended.text;
  for (const char* name : {"odometry.tum", "odometry_covariance.txt", "odometry_innovation.txt", "trajectory.tum",
                           "mesh.ply", "cloud.ply", "map.db", "rig.yaml", "report.json", "overview.png"}) {
    EXPECT_TRUE(fs::exists(folder_ / "one" / name)) << name;
  }
  const auto report = nlohmann::json::parse(test::read_file(folder_ / "one" / "report.json"));
  EXPECT_EQ(report["sweeps"], 4);
  EXPECT_EQ(report["threads"], 1);

  const std::string again =
      "replay " + room + " --rig " + path("one/rig.yaml") + " --set threads=2 --out " + path("two");
  ASSERT_EQ(lxd_slam(again).status, 0);
  for (const char* name :
       {"odometry.tum", "odometry_covariance.txt", "odometry_innovation.txt", "mesh.ply", "cloud.ply"}) {
    EXPECT_EQ(test::read_file(folder_ / "one" / name), test::read_file(folder_ / "two" / name)) << name;
  }
  EXPECT_EQ(
      lxd_slam("export " + path("one") + " --trajectory " + path("out.kitti") + " --mesh " + path("out.glb")).status,
      0);
  EXPECT_TRUE(fs::exists(path("out.kitti")));
  const std::string evaluate =
      "evaluate --estimate " + path("one/odometry.tum") + " --truth " + path("two/odometry.tum");
  EXPECT_EQ(lxd_slam(evaluate + " --plots " + path("one")).status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "one" / "errors.png"));
  EXPECT_EQ(lxd_slam(evaluate + " --plots " + path("none")).status, 2) << "known before work begins";
}

TEST_F(Cli, ReplayInRealTimeKeepsPace) {
  const Ended ended = lxd_slam("replay " + record_room(4) + " --realtime --out " + path("run"));
  ASSERT_EQ(ended.status, 0) << ended.text;
  const auto report = nlohmann::json::parse(test::read_file(folder_ / "run" / "report.json"));
  const std::uint64_t late = report["dropped"].value("late", std::uint64_t{0});
  EXPECT_EQ(report["sweeps"].get<std::uint64_t>() + late, 4U);
}

TEST_F(Cli, ReplayEndsAfterTheWantedSweeps) {
  ASSERT_EQ(lxd_slam("replay " + record_room(5) + " --set replay.sweeps=2 --out " + path("run")).status, 0);
  EXPECT_EQ(nlohmann::json::parse(test::read_file(folder_ / "run" / "report.json"))["sweeps"], 2);
}

TEST_F(Cli, ExportOfWhatIsNoRunIsBadUsage) {
  EXPECT_EQ(lxd_slam("export " + folder_.path().string() + " --mesh m.ply").status, 2);
}

TEST_F(Cli, EvaluateOfFilesThatAreNotThereIsBadUsage) {
  EXPECT_EQ(lxd_slam("evaluate --estimate " + path("a.tum") + " --truth " + path("b.tum")).status, 2);
}

}  // namespace
}  // namespace lxd::cli_program_test
