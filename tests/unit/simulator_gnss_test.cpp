// SPDX-License-Identifier: Apache-2.0
// A simulated receiver, read back by the parser: exact without noise, errors as large and as slow as asked, what walls
// and roofs do to it, and every fault.
#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/simulated_drive.hpp"
#include "tests/support/simulated_receiver.hpp"

namespace lxd::sim::simulator_gnss_test {
namespace {

using test::Drive;
using test::exact_gnss;
using test::SimulatedReceiver;

TEST_F(SimulatedReceiver, PositionIsTheAntennas) {
  const Drive drive(20);
  const GnssConfig config = exact_gnss();
  const auto fixes = read(drive, config);
  ASSERT_EQ(fixes.size(), 100U);
  for (const Fix& fix : fixes) {
    EXPECT_LT(fix.error_m.norm(), 0.2e-3);
    EXPECT_EQ(fix.fix.quality, GnssQuality::rtk_fixed);
    EXPECT_TRUE(fix.fix.satellites == 22U);
  }
}

TEST_F(SimulatedReceiver, SpeedAndCourseAreTheAntennas) {
  const Drive drive(20);
  const GnssConfig config = exact_gnss();
  constexpr double kH_s = 1e-4;
  for (const Fix& fix : read(drive, config)) {
    const Eigen::Vector3d v =
        (antenna_enu(drive, config, fix.t_s + kH_s) - antenna_enu(drive, config, fix.t_s - kH_s)) / (2 * kH_s);
    EXPECT_NEAR(fix.fix.speed_mps.value(), v.head<2>().norm(), 1e-4);
    EXPECT_NEAR(std::remainder(fix.fix.course_rad.value() - std::atan2(v.x(), v.y()), 2 * std::numbers::pi), 0, 1e-4);
  }
}

TEST_F(SimulatedReceiver, WorldsXIsTurnedFromEastByTheYaw) {
  const Drive drive(1);
  GnssConfig config = exact_gnss();
  config.enu_yaw_rad = std::numbers::pi / 2;  // the world's x is north
  const auto fixes = read(drive, config);
  const Eigen::Vector3d in_world = drive.motion.at(fixes[0].t_s).T_world_body * config.antenna_in_reference_m;
  EXPECT_NEAR(fixes[0].enu_m.x(), -in_world.y(), 1e-3);
  EXPECT_NEAR(fixes[0].enu_m.y(), in_world.x(), 1e-3);
}

TEST_F(SimulatedReceiver, UtcIsTheReceiversClock) {
  const Drive drive(10);
  GnssConfig config = exact_gnss();
  config.clock.offset_s = 0.123;
  config.clock.latency_s = 0.02;
  const auto fixes = read(drive, config);
  ASSERT_EQ(fixes.size(), 50U);
  for (const Fix& fix : fixes) {
    EXPECT_EQ(fix.fix.utc_ns.value() % 200'000'000, 0);
    EXPECT_EQ(fix.fix.utc_ns.value(), drive.context.rig_time(fix.t_s).ns() + 123'000'000);
    EXPECT_NEAR((fix.fix.received - drive.context.rig_time(fix.t_s)).seconds(), 0.07, 1e-6);
    EXPECT_LT(fix.error_m.norm(), 0.2e-3) << "at its own time";
  }
}

// Given errors that are correlated over 2 s, when 1000 s are simulated, then their size and their memory are as asked.
TEST_F(SimulatedReceiver, ErrorsAreAsLargeAndAsSlowAsAsked) {
  const Drive drive(1000);
  GnssConfig config = exact_gnss();
  config.sigma_fixed_m = 0.5;
  config.vertical_factor = 2;
  config.white_part = 0.2;
  config.correlation_time_s = 2;
  const auto fixes = read(drive, config);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  double lagged = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    squares += fixes[i].error_m.cwiseAbs2();
    if (i > 0) lagged += fixes[i].error_m.head<2>().dot(fixes[i - 1].error_m.head<2>());
    EXPECT_NEAR(fixes[i].fix.sigma_latitude_m.value(), 0.5, 1e-3);
    EXPECT_NEAR(fixes[i].fix.sigma_altitude_m.value(), 1.0, 1e-3);
  }
  const Eigen::Vector3d sigma_m = (squares / static_cast<double>(fixes.size())).cwiseSqrt();
  EXPECT_NEAR(sigma_m.x(), 0.5, 0.07);
  EXPECT_NEAR(sigma_m.y(), 0.5, 0.07);
  EXPECT_NEAR(sigma_m.z(), 1.0, 0.14);
  EXPECT_NEAR(lagged / squares.head<2>().sum(), (1 - 0.04) * std::exp(-0.1), 0.03);
}

// Given a roof over half of the way, when the rig drives under it, then there is no fix, then single or float, then
// fixed.
TEST_F(SimulatedReceiver, RoofTakesTheFix) {
  World world = open_ground_with_roof();
  const Drive drive(60, world);
  GnssConfig config = exact_gnss();
  config.rtk_fix_s = 4;
  const auto fixes = read(drive, config);
  EXPECT_GT(log_.none, 60U);
  EXPECT_GT(log_.rtk_float, 15U);
  EXPECT_GT(log_.rtk_fixed, 60U);
  EXPECT_EQ(log_.single, 0U);
  EXPECT_EQ(log_.epochs, 300U);
  EXPECT_EQ(fixes.size(), 300U);
  const auto first_none = std::find_if(fixes.begin(), fixes.end(), [](const Fix& f) { return !f.fix.has_position(); });
  ASSERT_NE(first_none, fixes.end());
  EXPECT_FALSE(first_none->fix.latitude_deg || first_none->fix.altitude_msl_m || first_none->fix.sigma_latitude_m);
  EXPECT_TRUE(first_none->fix.utc_ns) << "the receiver keeps its time";
  const auto back = std::find_if(first_none, fixes.end(), [](const Fix& f) { return f.fix.has_position(); });
  ASSERT_NE(back, fixes.end());
  EXPECT_EQ(back->fix.quality, GnssQuality::rtk_float);
}

TEST_F(SimulatedReceiver, PaneOfGlassHidesNothing) {
  const Drive drive(30, open_ground_with_roof(1));
  read(drive, exact_gnss());
  EXPECT_EQ(log_.rtk_fixed, log_.epochs);
}

TEST_F(SimulatedReceiver, FacadesCostSatellitesAndAccuracy) {
  World world = test::open_ground();
  test::add_quad(world, {-30, -23, -5}, {60, 0, 0}, {0, 0, 60});  // 3 m beside the southernmost part of the circle
  const Drive drive(40, world);
  GnssConfig config = exact_gnss();
  config.rtk = false;
  config.sigma_single_m = 1;
  config.multipath_m = 4;
  double near_sigma_m = 0, far_sigma_m = 1e9;
  std::uint32_t near_satellites = 99;
  for (const Fix& fix : read(drive, config)) {
    EXPECT_EQ(fix.fix.quality, GnssQuality::single);
    near_sigma_m = std::max(near_sigma_m, fix.fix.sigma_latitude_m.value());
    far_sigma_m = std::min(far_sigma_m, fix.fix.sigma_latitude_m.value());
    near_satellites = std::min(near_satellites, fix.fix.satellites.value());
  }
  EXPECT_GT(near_sigma_m, 1.5 * far_sigma_m);
  EXPECT_LT(near_satellites, 16U);
}

TEST_F(SimulatedReceiver, JumpIsAtOnceAndSpoofIsDragged) {
  const Drive drive(60, test::open_ground(), {{"gnss_jump", 5, 10, 20}, {"gnss_spoof", 20, 55, 100}});
  for (const Fix& fix : read(drive, exact_gnss())) {
    double expected_m = 0;
    if (fix.t_s >= 5 && fix.t_s < 10) expected_m = 20;
    if (fix.t_s >= 20 && fix.t_s < 55) expected_m = 100 * std::min(1.0, (fix.t_s - 20) / 30);
    EXPECT_NEAR(fix.error_m.norm(), expected_m, 1e-3) << fix.t_s;
    EXPECT_EQ(fix.fix.quality, GnssQuality::rtk_fixed) << "a spoofed receiver is sure of itself";
  }
}

TEST_F(SimulatedReceiver, EmptyAndRtkLossFaults) {
  const Drive drive(60, test::open_ground(), {{"gnss_empty", 10, 20, 0}, {"gnss_rtk_loss", 40, 45, 0}});
  GnssConfig config = exact_gnss();
  config.reacquire_s = 2;
  config.rtk_fix_s = 5;
  for (const Fix& fix : read(drive, config)) {
    const auto in = [&](double begin_s, double end_s) { return fix.t_s >= begin_s && fix.t_s < end_s - 0.01; };
    GnssQuality expected = GnssQuality::rtk_fixed;
    if (in(10, 21.8)) expected = GnssQuality::none;
    if (in(40, 45)) expected = GnssQuality::single;
    if (in(21.8, 26.6) || in(45, 49.8)) expected = GnssQuality::rtk_float;
    EXPECT_EQ(fix.fix.quality, expected) << fix.t_s;
  }
}

// Given a leap second, when it is over, then UTC is a second behind for good and one second came twice.
TEST_F(SimulatedReceiver, LeapSecondRepeatsASecond) {
  // 1 750 000 000 s is 15:06:40; after :59 comes :60.
  for (const double begin_s : {5.3, 19.7}) {
    const Drive drive(30, test::open_ground(), {{"leap_second", begin_s, 1e9, 0}});
    const double leap_s = std::ceil(begin_s);
    const std::string second = begin_s > 10 ? "15065" + std::string("9.800") : "150645.800";
    for (const Fix& fix : read(drive, exact_gnss())) {
      const double behind_s = (drive.context.rig_time(fix.t_s) - RigTime::from_ns(*fix.fix.utc_ns)).seconds();
      const bool sixty = begin_s > 10 && fix.t_s >= leap_s && fix.t_s < leap_s + 1 - 1e-6;
      EXPECT_NEAR(behind_s, fix.t_s < leap_s - 1e-6 || sixty ? 0 : 1, 1e-6) << fix.t_s;
    }
    const std::string text = test::read_file(folder_ / "gnss.nmea");
    EXPECT_EQ(text.find("GNGGA,150660.000") != std::string::npos, begin_s > 10);
    EXPECT_EQ(count(text, "GNGGA," + second), begin_s > 10 ? 1U : 2U);
  }
}

TEST_F(SimulatedReceiver, SameSeedSameBytes) {
  const auto bytes = [&](std::uint64_t seed) {
    const Drive drive(5, test::open_ground(), {}, seed);
    EXPECT_TRUE(write_gnss(drive.context, {}, folder_.path()).ok());
    return test::read_file(folder_ / "gnss.nmea");
  };
  EXPECT_EQ(bytes(1), bytes(1));
  EXPECT_NE(bytes(1), bytes(2));
}

TEST_F(SimulatedReceiver, WhatCannotBeIsAnError) {
  const Drive drive(1);
  const auto unwritable = write_gnss(drive.context, {}, folder_ / "none");
  ASSERT_FALSE(unwritable.ok());
  EXPECT_NE(unwritable.error().message.find("gnss.nmea"), std::string::npos);
  GnssConfig nowhere;
  nowhere.origin.latitude_deg = 91;
  EXPECT_FALSE(write_gnss(drive.context, nowhere, folder_.path()).ok());
}

TEST(SimulatedReceiverKeys, AreReadAndChecked) {
  const auto problems_of = [](const char* text, GnssConfig& config) {
    Problems problems;
    YamlSection section(YAML::Load(text), "gnss", "scenario.yaml", problems);
    read_keys(section, config);
    section.reject_unknown();
    return problems;
  };
  GnssConfig config;
  EXPECT_TRUE(
      problems_of("{rate_hz: 10, rtk: off, antenna_in_reference_m: [0.1, 0, 1.5], mask_deg: 15}", config).empty());
  EXPECT_EQ(config.rate_hz, 10);
  EXPECT_FALSE(config.rtk);
  EXPECT_EQ(config.antenna_in_reference_m.z(), 1.5);
  EXPECT_EQ(problems_of("{rate_hz: 3, origin_latitude_deg: 95, blocked_no_fix: 80, satelites: 5}", config).size(), 4U);
}

// Every line is a sentence that the parser knows, in an order that a wire could have.
TEST_F(SimulatedReceiver, SentencesFollowEachOtherOnTheWire) {
  const Drive drive(10);
  GnssConfig config;
  config.clock.latency_jitter_s = 0.15;
  config.baud_rate = 19200;
  const auto log = write_gnss(drive.context, config, folder_.path());
  ASSERT_TRUE(log.ok());
  auto reader = NmeaLog::open(folder_ / "gnss.nmea");
  NmeaParser parser;
  RigTime last;
  for (NmeaChunk chunk; reader->next(chunk);) {
    EXPECT_GE(chunk.received, last);
    last = chunk.received;
    parser.feed(chunk.bytes, chunk.received, [](const GnssFix&) {});
  }
  const NmeaCounts& counts = parser.counts();
  EXPECT_EQ(counts.gga + counts.rmc + counts.gst + counts.gsa, log->sentences);
  EXPECT_EQ(log->sentences, 200U);
  EXPECT_EQ(counts.bad_field + counts.other_sentence + counts.late + parser.framer_counts().bad_checksum, 0U);
}

TEST_F(SimulatedReceiver, ALineTooSlowIsToldBeforeWork) {
  GnssConfig config;
  config.rate_hz = 10;
  config.baud_rate = 9600;
  const Status slow = check_gnss(config);
  ASSERT_FALSE(slow.ok());
  EXPECT_NE(slow.error().message.find("gnss: found a baud_rate of 9600, wanted at least"), std::string::npos);
  EXPECT_FALSE(write_gnss(Drive(1).context, config, folder_.path()).ok());
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  config.rate_hz = 1;
  EXPECT_TRUE(check_gnss(config).ok());
}

// gpsd's own decoder, which knows nothing of ours. It skips the host times before the sentences by itself.
TEST_F(SimulatedReceiver, WitnessGpsdecode) {
  if (!test::has_program("gpsdecode")) GTEST_SKIP() << "no gpsdecode (gpsd)";
  const Drive drive(30, test::open_ground(), {{"gnss_empty", 10, 15, 0}});
  const auto fixes = read(drive, exact_gnss());
  for (const char* const feed : {"cut -d' ' -f2", "cat"}) {
    const std::string decoded = (folder_ / "decoded.json").string();
    const std::string command =
        std::string(feed) + " '" + (folder_ / "gnss.nmea").string() + "' | gpsdecode > '" + decoded + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::istringstream lines(test::read_file(decoded));
    std::size_t found = 0;
    for (std::string line; std::getline(lines, line);) {
      const auto report = nlohmann::json::parse(line, nullptr, false);
      if (report.is_discarded() || report.value("class", "") != "TPV" || !report.contains("lat")) continue;
      const auto near = std::find_if(fixes.begin(), fixes.end(), [&](const Fix& fix) {
        return fix.fix.has_position() && std::abs(*fix.fix.latitude_deg - report["lat"].get<double>()) < 2e-9 &&
               std::abs(*fix.fix.longitude_deg - report["lon"].get<double>()) < 2e-9;
      });
      EXPECT_NE(near, fixes.end()) << line;
      ++found;
    }
    EXPECT_GE(found, log_.rtk_fixed + log_.rtk_float - 1) << feed;  // the last epoch may not be printed
  }
}

}  // namespace
}  // namespace lxd::sim::simulator_gnss_test
