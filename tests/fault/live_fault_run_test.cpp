// SPDX-License-Identifier: Apache-2.0
// `lxd-slam run` against a rig whose wires are in trouble all the time: two LiDARs over UDP, an IMU and a GNSS receiver
// over serial lines, everything at its own pace. Nothing crashes, nothing grows, what was done to the wires is what the
// report counts, and the filter is whole again soon after each sensor's return.
//
// LXD_FAULT_RUN_S says for how long (30 s if it does not), LXD_FAULT_RUN_SEED in which order and where.
#include <csignal>
#include <cstdlib>

#include "drivers/device/host_clock.hpp"
#include "drivers/replay/ouster_metadata_file.hpp"
#include "tests/support/emulated.hpp"
#include "tests/support/live_fault_result.hpp"
#include "tests/support/ouster_ledger.hpp"
#include "tests/support/run_result.hpp"
#include "tests/support/wire_faults.hpp"

namespace lxd::test::live_fault_run_test {
namespace {

namespace fs = std::filesystem;

// Sparse and slow, so that a machine with two cores that others use too keeps up.
constexpr const char* kRig = R"yaml(
world: building
motion: {carrier: handheld, rest_s: 1.5, vigour: 0.3}
lidar0: {model: ouster, product: OS0, beams: 16, columns: 512, profile: RNG15_RFL8_NIR8, imu: NONE}
lidar1: {model: livox, imu: false, T_body_sensor: [1,0,0,0, 0,1,0,0, 0,0,1,0.1, 0,0,0,1]}
imu: {protocol: vectornav, update_rate: 200}
gnss: {rate_hz: 5}
)yaml";

double number_from(const char* variable, double otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atof(text);
}

// Of a process, as the kernel has it now.
double rss_mib(pid_t process) {
  std::ifstream status(fmt::format("/proc/{}/status", process));
  constexpr double kKibibytesPerMebibyte = 1024;
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / kKibibytesPerMebibyte;
  return 0;
}

class LiveFaultRun : public testing::Test {
 protected:
  void SetUp() override {
    if (emulated()) GTEST_SKIP() << kNoSerialLine;
    write_file(folder_ / "scenario.yaml", kRig);
    const Ended made =
        lxd_slam(fmt::format("simulate {} --seed {} --duration {}{} --out {}", (folder_ / "scenario.yaml").string(),
                             seed_, duration_s_, schedule_.simulator_options(), recording_.string()));
    EXPECT_EQ(made.status, 0) << made.text;
    player_.emplace(recording_, folder_);
    player_->edit([this](Pieces& all) { faults_.apply(all); });
    simulated_ = nlohmann::json::parse(read_file(recording_ / "simulation.json"))["counts"];
  }

  Ended play() {
    Program program(fmt::format("run --rig {} --out {} --quiet", player_->rig_file().string(), run_.string()));
    for (int i = 0; i < 3000 && !exists(run_ / "rig.yaml"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::seconds(1));  // until serial lines are open
    start_ = clock_.now();
    double next_look_s = 0;
    player_->play(0, 2 * duration_s_, 1, [&](const PlayedBytes& piece, double t_s) {
      if (piece.wire == "lidar0") ouster_->add(piece);
      if (t_s < next_look_s) return true;
      next_look_s = t_s + 1;
      rss_mib_.push_back(rss_mib(program.id()));
      return true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    program.signal(SIGINT);
    return program.wait();
  }

  // All that was done to the wires, by the names of the report.
  [[nodiscard]] WireLedger expected() const {
    WireLedger all = player_->told();
    for (const WireLedger* const more : {&faults_.lost(), &ouster_->counts()})
      for (const auto& [name, times] : *more) all[name] += times;
    all["imu.non_finite"] = simulated_["imu"]["nan"];
    all["lidar0.invalid_column"] = simulated_["lidar0"]["emptied"].get<std::uint64_t>() * 16;
    // There and back again; a sensor that restarts counts its time from zero.
    all["lidar0.clock_step"] = 2 * schedule_.times("lidar0_time_step") + schedule_.times("lidar0_restart");
    all["imu.clock_step"] = 2 * schedule_.times("imu_time_step");
    return all;
  }

  const double duration_s_ = number_from("LXD_FAULT_RUN_S", 30);
  const std::uint64_t seed_ = static_cast<std::uint64_t>(number_from("LXD_FAULT_RUN_SEED", 1));
  const FaultSchedule schedule_{duration_s_, seed_};
  WireFaults faults_{schedule_, seed_, duration_s_};
  TemporaryFolder folder_;
  fs::path recording_ = folder_ / "recording", run_ = folder_ / "live";
  std::optional<WirePlayer> player_;
  std::optional<OusterLedger> ouster_;
  nlohmann::json simulated_;
  HostClock clock_;
  RigTime start_;
  std::vector<double> rss_mib_;  // every second
};

TEST_F(LiveFaultRun, CountsWhatWasDoneAndIsWholeAgainSoon) {
  const auto metadata = read_ouster_metadata(recording_ / "lidar0.json");
  ASSERT_TRUE(metadata.ok());
  ouster_.emplace(*metadata);
  const Ended ended = play();
  ASSERT_EQ(ended.status, 0) << ended.text;
  const LiveFaultResult result(run_, recording_, start_ - player_->first());
  for (const auto& [kind, times] : faults_.done()) fmt::print("done {:28} {}\n", kind, times);

  const WireLedger expected = this->expected();
  const auto counted = [&](const std::string& name) { return result.counted(name, *player_, folder_.path()); };
  for (const auto& [name, times] : expected) {
    fmt::print("count {:28} done {:6} counted {:6}\n", name, times, counted(name));
    EXPECT_EQ(counted(name), times) << name;
  }
  for (const char* const never :
       {"lidar0.no_room", "lidar1.no_room", "imu.no_room", "gnss.no_room", "lidar0.kernel_overflow",
        "lidar1.kernel_overflow", "lidar0.cut", "imu.too_long", "imu.unknown_field"})
    EXPECT_EQ(counted(never), 0U) << never;
  for (const char* const wire : {"imu", "gnss"})
    EXPECT_EQ(counted(std::string(wire) + ".bytes"), player_->sent_bytes(wire)) << wire;
  result.expect_silences(*player_);

  for (const FaultSlot& slot : schedule_.slots()) result.expect_recovery(slot);
  result.expect_true_motion(schedule_);

  const auto report = result.report();
  EXPECT_EQ(report["rt_allocations"], 0);
  ASSERT_GT(rss_mib_.size(), 8U);
  const double grown_mib = rss_mib_.back() - rss_mib_[rss_mib_.size() / 4];
  fmt::print("rss {:.0f} MiB at a quarter, {:.0f} MiB at the end, {:.0f} MiB at most\n", rss_mib_[rss_mib_.size() / 4],
             rss_mib_.back(), report["peak_rss_mib"].get<double>());
  // The path, the map's archive and the graph do grow; a queue that nobody empties would by megabytes a second.
  EXPECT_LT(grown_mib, 64 + 0.2 * duration_s_);
  fmt::print("rejected {}\n", report["rejected"].dump());
  fmt::print("dropped {}\nupdates {}\npools {}\nlatency {}\n", report["dropped"].dump(), report["updates"].dump(),
             report["pools"].dump(), report["live"]["latency_ms"].dump());
}

}  // namespace
}  // namespace lxd::test::live_fault_run_test
