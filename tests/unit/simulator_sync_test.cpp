// SPDX-License-Identifier: Apache-2.0
// Simulated time signals: pulses and trigger edges where they should be, what is missing and what is too much, and a
// clock that learns from them.
#include <gtest/gtest.h>

#include "drivers/gnss/nmea_parser.hpp"
#include "drivers/replay/nmea_log.hpp"
#include "drivers/replay/pps_log.hpp"
#include "drivers/sync/clock_model.hpp"
#include "tests/support/simulated_drive.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/gnss/gnss_writer.hpp"
#include "tools/simulator/sync/sensor_instants.hpp"
#include "tools/simulator/sync/sync_writer.hpp"

namespace lxd::sim::simulator_sync_test {
namespace {

using test::Drive;

SyncConfig exact() {
  SyncConfig config;
  config.jitter_s = config.missing_probability = config.spurious_probability = 0;
  return config;
}

class SimulatedSync : public testing::Test {
 protected:
  struct Event {
    std::int64_t ns;
    int offset;
    std::string line, edge;
    std::uint32_t seqno, line_seqno;
  };

  PpsLog pulses(const Drive& drive, const SyncConfig& config) {
    const auto log = write_sync(drive.context, config, folder_.path());
    EXPECT_TRUE(log.ok());
    log_ = *log;
    const auto pulses = read_pps_log(folder_ / "pps.csv");
    EXPECT_TRUE(pulses.ok()) << (pulses.ok() ? "" : pulses.error().message);
    return *pulses;
  }

  std::vector<Event> events() {
    std::istringstream file(test::read_file(folder_ / "gpio.csv"));
    std::vector<Event> events;
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, kGpioLogHeader);
    while (std::getline(file, line)) {
      long long ns = 0;
      char name[32], edge[32];
      Event event{};
      EXPECT_EQ(std::sscanf(line.c_str(), "%lld,%d,%31[^,],%31[^,],%u,%u", &ns, &event.offset, name, edge, &event.seqno,
                            &event.line_seqno),
                6)
          << line;
      event.ns = ns;
      event.line = name;
      event.edge = edge;
      events.push_back(event);
    }
    return events;
  }

  test::TemporaryFolder folder_;
  SyncLog log_;
};

TEST_F(SimulatedSync, PulsesAreAtWholeSeconds) {
  const Drive drive(10);
  const PpsLog log = pulses(drive, exact());
  ASSERT_EQ(log.edges.size(), 10U);
  for (std::size_t i = 0; i < log.edges.size(); ++i) {
    EXPECT_EQ(log.edges[i].asserted, drive.context.rig_time(static_cast<double>(i)));
    EXPECT_EQ(log.edges[i].sequence, i + 1);
  }
}

TEST_F(SimulatedSync, PulsesFollowTheirOwnClock) {
  const Drive drive(60);
  SyncConfig config = exact();
  config.clock = {0.25, 200, 0, 5e-6, 0};  // UTC is ahead by 0.25 s and gains 200 us a second
  const PpsLog log = pulses(drive, config);
  for (std::size_t i = 0; i < log.edges.size(); ++i)
    EXPECT_NEAR(drive.seconds_of(log.edges[i].asserted), (static_cast<double>(i) + 0.75) / (1 + 200e-6) + 5e-6, 10e-9);
}

TEST_F(SimulatedSync, JitterOnlyDelays) {
  const Drive drive(600);
  SyncConfig config = exact();
  config.jitter_s = 20e-6;
  double sum_s = 0;
  const PpsLog log = pulses(drive, config);
  for (std::size_t i = 0; i < log.edges.size(); ++i) {
    const double late_s = drive.seconds_of(log.edges[i].asserted) - static_cast<double>(i);
    EXPECT_GE(late_s, 0);
    sum_s += late_s;
  }
  EXPECT_NEAR(sum_s / 600, 20e-6, 3e-6);
}

TEST_F(SimulatedSync, MissingAndSpuriousAsOftenAsAsked) {
  const Drive drive(2000);
  SyncConfig config = exact();
  config.missing_probability = 0.05;
  config.spurious_probability = 0.1;
  const PpsLog log = pulses(drive, config);
  EXPECT_NEAR(static_cast<double>(log_.missing), 100, 40);
  EXPECT_NEAR(static_cast<double>(log_.spurious), 200, 50);
  EXPECT_EQ(log_.pulses + log_.missing, 2000U);
  EXPECT_EQ(log.edges.size(), log_.pulses + log_.spurious);
  EXPECT_EQ(log.lost, 0U) << "the kernel cannot miss what never came";
}

TEST_F(SimulatedSync, FaultsHaveTheirTime) {
  const Drive drive(40, test::open_ground(), {{"pps_missing", 10, 20, 0}, {"pps_glitch", 30, 35, 2}});
  std::size_t missing_window = 0, glitch_window = 0;
  for (const PpsEdge& edge : pulses(drive, exact()).edges) {
    const double t_s = drive.seconds_of(edge.asserted);
    missing_window += t_s >= 10 && t_s < 20;
    glitch_window += t_s >= 30 && t_s < 35;
  }
  EXPECT_EQ(missing_window, 0U);
  EXPECT_EQ(glitch_window, 15U);
  EXPECT_EQ(log_.missing, 10U);
  EXPECT_EQ(log_.spurious, 10U);
}

TEST_F(SimulatedSync, TriggersAreEdgesOfTheirLine) {
  const Drive drive(5);
  SyncConfig config = exact();
  config.triggers = {{"camera0", {0.1, 0.2, 0.35}, 0.002}, {"lidar0", {0.5}, 0.001}};
  pulses(drive, config);
  const std::vector<Event> all = events();
  EXPECT_EQ(all.size(), 2U * (5 + 3 + 1));
  EXPECT_EQ(log_.gpio_events, all.size());
  std::vector<double> rising, falling;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].seqno, i + 1);
    EXPECT_TRUE(i == 0 || all[i - 1].ns <= all[i].ns);
    if (all[i].line != "camera0") continue;
    EXPECT_EQ(all[i].offset, 1);
    (all[i].edge == "rising" ? rising : falling).push_back(drive.seconds_of(RigTime::from_ns(all[i].ns)));
  }
  ASSERT_EQ(rising.size(), 3U);
  EXPECT_NEAR(rising[2], 0.35, 1e-9);
  EXPECT_NEAR(falling[2], 0.352, 1e-9);
}

TEST_F(SimulatedSync, LostEventsAreGapsInTheCount) {
  const Drive drive(1);
  SyncConfig config = exact();
  config.missing_probability = 0.2;
  TriggerLine camera{"camera0", {}, 0.001};
  for (int i = 0; i < 500; ++i) camera.times_s.push_back(0.0021 * i);
  config.triggers = {camera};
  pulses(drive, config);
  std::uint32_t last = 0, gaps = 0;
  for (const Event& event : events()) {
    if (event.line != "camera0") continue;
    gaps += event.line_seqno - last - 1;
    last = event.line_seqno;
  }
  EXPECT_NEAR(static_cast<double>(log_.gpio_lost), 200, 45);
  EXPECT_EQ(gaps + (1000 - last), log_.gpio_lost);
}

TEST_F(SimulatedSync, SameSeedSameBytes) {
  const auto bytes = [&](std::uint64_t seed) {
    const Drive drive(50, test::open_ground(), {}, seed);
    EXPECT_TRUE(write_sync(drive.context, {}, folder_.path()).ok());
    return test::read_file(folder_ / "pps.csv") + test::read_file(folder_ / "gpio.csv");
  };
  EXPECT_EQ(bytes(1), bytes(1));
  EXPECT_NE(bytes(1), bytes(2));
}

TEST_F(SimulatedSync, FolderThatCannotBeWrittenIsNamed) {
  const Drive drive(1);
  const auto log = write_sync(drive.context, {}, folder_ / "none");
  ASSERT_FALSE(log.ok());
  EXPECT_NE(log.error().message.find("pps.csv"), std::string::npos);
}

TEST(SimulatedSyncKeys, AreReadAndChecked) {
  Problems problems;
  YamlSection section(YAML::Load("{jitter_s: 0.00001, missing_probability: 2, pulse: 1}"), "pps", "s.yaml", problems);
  SyncConfig config;
  read_keys(section, config);
  section.reject_unknown();
  EXPECT_EQ(config.jitter_s, 1e-5);
  EXPECT_EQ(problems.size(), 2U);
}

// A rig's clock from its own recording: messages say which second, pulses say when.
class SimulatedClock : public SimulatedSync {
 protected:
  struct Outcome {
    double worst_s = 0;  // of what to_rig() gives for UTC, from learned_s on
    ClockCounts counts;
    bool locked = false;
  };

  Outcome learn(const Drive& drive, const ClockConfig& utc, double learned_s) {
    GnssConfig gnss;
    gnss.clock = utc;
    gnss.clock.latency_jitter_s = 3e-3;
    EXPECT_TRUE(write_gnss(drive.context, gnss, folder_.path()).ok());
    SyncConfig sync;
    sync.clock = utc;
    const PpsLog edges = pulses(drive, sync);
    const SensorClock clock(utc, drive.context.start);
    ClockModel model{{}};
    Outcome outcome;
    std::size_t edge = 0;
    const auto on_fix = [&](const GnssFix& fix) {
      for (; edge < edges.edges.size() && edges.edges[edge].asserted <= fix.received; ++edge)
        model.add_edge(edges.edges[edge].asserted);
      model.add(*fix.utc_ns, fix.received);
      if (drive.seconds_of(fix.received) < learned_s) return;
      const double error_s = (model.to_rig(*fix.utc_ns) - rig_time_of(clock, *fix.utc_ns)).seconds();
      outcome.worst_s = std::max(outcome.worst_s, std::abs(error_s));
    };
    auto log = NmeaLog::open(folder_ / "gnss.nmea");
    NmeaParser parser;
    for (NmeaChunk chunk; log->next(chunk);) parser.feed(chunk.bytes, chunk.received, on_fix);
    outcome.counts = model.counts();
    outcome.locked = model.pulse_locked();
    return outcome;
  }
};

TEST_F(SimulatedClock, IsLearnedToMicroseconds) {
  const Drive drive(120);
  const Outcome outcome = learn(drive, {0.3, 50, 0, 0, 0}, 40);
  EXPECT_TRUE(outcome.locked);
  EXPECT_LT(outcome.worst_s, 30e-6);
  EXPECT_EQ(outcome.counts.steps, 0U);
}

TEST_F(SimulatedClock, SurvivesMissingPulsesAndGlitches) {
  const Drive drive(800, test::open_ground(), {{"pps_glitch", 50, 80, 3}, {"pps_missing", 100, 700, 0}});
  const Outcome outcome = learn(drive, {0.3, 50, 0, 0, 0}, 40);
  EXPECT_TRUE(outcome.locked);
  EXPECT_LT(outcome.worst_s, 0.3e-3);
  EXPECT_GE(outcome.counts.glitches, 90U);
  EXPECT_EQ(outcome.counts.relocks, 0U);
  RecordProperty("worst_us", std::to_string(outcome.worst_s * 1e6));
}

}  // namespace
}  // namespace lxd::sim::simulator_sync_test
