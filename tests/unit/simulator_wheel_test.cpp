// SPDX-License-Identifier: Apache-2.0
// Simulated wheels, read back by the decoder: exact without noise, wrong where and as much as asked.
#include <cstdlib>

#include <gtest/gtest.h>

#include "drivers/replay/can_log.hpp"
#include "drivers/wheel/wheel_decoder.hpp"
#include "tests/support/simulated_drive.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/wheel/wheel_writer.hpp"

namespace lxd::sim::simulator_wheel_test {
namespace {

WheelConfig exact(WheelProtocol protocol) {
  WheelConfig config;
  config.protocol = protocol;
  config.speed_sigma_mps = 0;
  if (protocol == WheelProtocol::toyota) config.track_m = 1.57;
  config.T_body_sensor = {Exp({0.02, -0.03, 0.1}), {-1.2, 0.3, -0.4}};
  return config;
}

class SimulatedWheels : public testing::Test {
 protected:
  struct Reading {
    std::vector<WheelSample> samples;
    std::vector<CanFrame> frames;
    WheelCounts counts;
    WheelLog log;
  };

  Reading read(const test::Drive& drive, const WheelConfig& config, WheelSource source) {
    Reading reading;
    const auto log = write_wheel(drive.context, config, folder_.path());
    EXPECT_TRUE(log.ok()) << (log.ok() ? "" : log.error().message);
    if (log.ok()) reading.log = *log;
    const bool agilex = config.protocol == WheelProtocol::agilex;
    WheelDecoder decoder({agilex ? agilex_messages() : toyota_messages(), source, config.track_m});
    auto reader = CanLogReader::open(folder_ / "can.log");
    EXPECT_TRUE(reader.ok());
    for (CanLogRecord record; reader->next(record);) {
      reading.frames.push_back(record.frame);
      if (const auto sample = decoder.decode(record.frame)) reading.samples.push_back(*sample);
    }
    EXPECT_EQ(reader->garbage() + reader->time_backwards(), 0U);
    reading.counts = decoder.counts();
    return reading;
  }

  // Speed along the wheel frame's x and rate about its z from the poses alone: difference quotients.
  struct Truth {
    double speed_mps, yaw_rate_radps;
  };
  static Truth truth(const test::Drive& drive, const WheelConfig& config, double t_s) {
    constexpr double kH_s = 1e-4;
    const auto wheel = [&](double t) { return drive.motion.at(t).T_world_body * config.T_body_sensor; };
    const Pose before = wheel(t_s - kH_s), now = wheel(t_s), after = wheel(t_s + kH_s);
    return {(now.R.transpose() * (after.p - before.p)).x() / (2 * kH_s),
            Log(Eigen::Matrix3d(before.R.transpose() * after.R)).z() / (2 * kH_s)};
  }

  test::TemporaryFolder folder_;
};

TEST_F(SimulatedWheels, AgilexMotionIsExactToItsSteps) {
  const test::Drive drive(10);
  const WheelConfig config = exact(WheelProtocol::agilex);
  const Reading reading = read(drive, config, WheelSource::motion);
  EXPECT_EQ(reading.samples.size(), 500U);
  for (const WheelSample& sample : reading.samples) {
    const Truth expected = truth(drive, config, drive.seconds_of(sample.received));
    EXPECT_NEAR(sample.speed_mps, expected.speed_mps, 0.51e-3);
    EXPECT_NEAR(sample.yaw_rate_radps, expected.yaw_rate_radps, 0.51e-3);
  }
}

// The odometer's ways add up: their rounding to millimetres does not.
TEST_F(SimulatedWheels, AgilexOdometerIsExactToAMillimetre) {
  const test::Drive drive(20);
  WheelConfig config = exact(WheelProtocol::agilex);
  for (const double start_mm : {0.0, 2147483647.0 - 5000, -2147483648.0 + 10}) {
    config.odometer_start_mm = start_mm;  // the second wraps after 5 m
    const Reading reading = read(drive, config, WheelSource::odometer);
    ASSERT_EQ(reading.samples.size(), 999U);
    double way_m = 0, turn_rad = 0, true_way_m = 0, true_turn_rad = 0;
    for (const WheelSample& sample : reading.samples) {
      way_m += sample.speed_mps * sample.span.seconds();
      turn_rad += sample.yaw_rate_radps * sample.span.seconds();
      const double end_s = drive.seconds_of(sample.received), begin_s = end_s - sample.span.seconds();
      const Truth a = truth(drive, config, begin_s), b = truth(drive, config, (begin_s + end_s) / 2),
                  c = truth(drive, config, end_s);
      true_way_m += (a.speed_mps + 4 * b.speed_mps + c.speed_mps) / 6 * sample.span.seconds();
      true_turn_rad += (a.yaw_rate_radps + 4 * b.yaw_rate_radps + c.yaw_rate_radps) / 6 * sample.span.seconds();
      EXPECT_NEAR(way_m, true_way_m, 1e-3);
    }
    EXPECT_GT(way_m, 50);
    EXPECT_NEAR(turn_rad, true_turn_rad, 2e-3 / config.track_m);
  }
}

TEST_F(SimulatedWheels, ToyotaIsExactToItsSteps) {
  const test::Drive drive(10);
  const WheelConfig config = exact(WheelProtocol::toyota);
  const Reading reading = read(drive, config, WheelSource::rear_wheels);
  EXPECT_EQ(reading.samples.size(), 500U);
  constexpr double kStep_mps = 0.01 / 3.6;
  for (const WheelSample& sample : reading.samples) {
    const Truth expected = truth(drive, config, drive.seconds_of(sample.received));
    EXPECT_NEAR(sample.speed_mps, expected.speed_mps, 0.51 * kStep_mps);
    EXPECT_NEAR(sample.yaw_rate_radps, expected.yaw_rate_radps, 1.01 * kStep_mps / config.track_m);
  }
  EXPECT_EQ(reading.counts.bad_checksum + reading.counts.bad_length + reading.counts.fault_bit, 0U);
  EXPECT_EQ(reading.counts.other_frames, 1000U);  // 0x0B4 and 0x024
  EXPECT_EQ(reading.counts.unknown_id, reading.log.other_frames);
  EXPECT_GT(reading.log.other_frames, 900U);
}

TEST_F(SimulatedWheels, NoiseAndScaleAreAsAsked) {
  const test::Drive drive(60);
  WheelConfig config = exact(WheelProtocol::toyota);
  config.speed_sigma_mps = 0.02;
  config.scale_error = 0.05;
  double sum = 0, squares = 0;
  const Reading reading = read(drive, config, WheelSource::rear_wheels);
  for (const WheelSample& sample : reading.samples) {
    const double error = sample.speed_mps - 1.05 * truth(drive, config, drive.seconds_of(sample.received)).speed_mps;
    sum += error;
    squares += error * error;
  }
  const auto n = static_cast<double>(reading.samples.size());
  EXPECT_NEAR(sum / n, 0, 1e-3);
  EXPECT_NEAR(std::sqrt(squares / n), 0.02 / std::sqrt(2.0), 1e-3);  // the mean of two wheels
}

TEST_F(SimulatedWheels, SlipIsTooFastForSomeTime) {
  const test::Drive drive(120);
  WheelConfig config = exact(WheelProtocol::agilex);
  config.slip_per_minute = 10;
  config.slip_part = 0.5;
  const Reading reading = read(drive, config, WheelSource::motion);
  std::size_t slipping = 0;
  for (const WheelSample& sample : reading.samples) {
    const double factor = sample.speed_mps / truth(drive, config, drive.seconds_of(sample.received)).speed_mps;
    slipping += factor > 1.1;
    EXPECT_LT(factor, 1.51);
    EXPECT_GT(factor, 0.99);
  }
  EXPECT_NEAR(static_cast<double>(slipping) / config.rate_hz, reading.log.slip_s, 0.5);
  EXPECT_GT(reading.log.slip_s, 5);
}

TEST_F(SimulatedWheels, SlipFaultHasItsTimeAndSize) {
  const test::Drive drive(10, test::open_ground(), {{"wheel_slip", 4, 6, 0.3}});
  const WheelConfig config = exact(WheelProtocol::agilex);
  for (const WheelSample& sample : read(drive, config, WheelSource::motion).samples) {
    const double t_s = drive.seconds_of(sample.received);
    const double factor = t_s >= 4 && t_s < 6 ? 1.3 : 1;
    EXPECT_NEAR(sample.speed_mps, factor * truth(drive, config, t_s).speed_mps, 1e-3) << t_s;
  }
}

TEST_F(SimulatedWheels, BusOffIsSilentAndReported) {
  const test::Drive drive(10, test::open_ground(), {{"can_bus_off", 3, 5, 0}});
  const Reading reading = read(drive, exact(WheelProtocol::agilex), WheelSource::odometer);
  for (const CanFrame& frame : reading.frames) {
    const double t_s = drive.seconds_of(frame.received);
    EXPECT_TRUE(t_s < 3 || t_s >= 5 || frame.kind == CanKind::error) << t_s;
  }
  EXPECT_EQ(reading.counts.bus_off, 1U);
  EXPECT_EQ(reading.counts.error_frames, 2U);
  EXPECT_EQ(reading.counts.gaps, 1U);
  EXPECT_NEAR(static_cast<double>(reading.log.withheld), 2 * 300, 3);  // 4 messages at 50 Hz and 100 others a second
  EXPECT_EQ(reading.counts.samples, 500U - 100 - 2);
  EXPECT_EQ(reading.counts.out_of_range, 0U);
  EXPECT_NE(test::read_file(folder_ / "can.log").find(" can0 20000040#"), std::string::npos);
}

TEST_F(SimulatedWheels, WrongChecksumsAreSeenOneByOne) {
  const test::Drive drive(10, test::open_ground(), {{"can_checksum", 2, 8, 0.4}});
  const Reading reading = read(drive, exact(WheelProtocol::toyota), WheelSource::rear_wheels);
  EXPECT_EQ(reading.counts.bad_checksum, reading.log.bad_checksums);
  EXPECT_NEAR(static_cast<double>(reading.log.bad_checksums), 0.4 * 600, 40);
  EXPECT_EQ(reading.counts.samples, 500U);
}

TEST_F(SimulatedWheels, ChecksumFaultNeedsAChecksum) {
  const test::Drive drive(1, test::open_ground(), {{"can_checksum", 0, 1, 1}});
  const auto log = write_wheel(drive.context, exact(WheelProtocol::agilex), folder_.path());
  ASSERT_FALSE(log.ok());
  EXPECT_NE(log.error().message.find("can_checksum"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

// The vehicle sends by its own clock, the host stamps what the bus delivers.
TEST_F(SimulatedWheels, ClockAndLatencyShowInTheStamps) {
  const test::Drive drive(20);
  WheelConfig config = exact(WheelProtocol::agilex);
  config.clock = {0.005, 1000, 0, 2e-3, 1e-3};
  config.other_frames_hz = 0;
  const Reading reading = read(drive, config, WheelSource::motion);
  ASSERT_GT(reading.samples.size(), 900U);
  for (std::size_t i = 0; i < reading.samples.size(); ++i) {
    const double sent_s = (0.015 + 0.02 * static_cast<double>(i)) / 1.001;
    const double late_s = drive.seconds_of(reading.samples[i].received) - sent_s;
    EXPECT_GT(late_s, 2e-3 - 20e-6);
    EXPECT_LT(late_s, 20e-3);
  }
}

TEST_F(SimulatedWheels, SameSeedSameBytes) {
  WheelConfig config;
  config.slip_per_minute = 20;
  config.csv = true;
  const auto bytes = [&](std::uint64_t seed) {
    const test::Drive drive(5, test::open_ground(), {}, seed);
    EXPECT_TRUE(write_wheel(drive.context, config, folder_.path()).ok());
    return test::read_file(folder_ / "can.log") + test::read_file(folder_ / "wheel.csv");
  };
  EXPECT_EQ(bytes(1), bytes(1));
  EXPECT_NE(bytes(1), bytes(2));
}

TEST_F(SimulatedWheels, CsvIsTheGenericFoldersForm) {
  const test::Drive drive(2);
  WheelConfig config = exact(WheelProtocol::agilex);
  config.csv = true;
  const Reading reading = read(drive, config, WheelSource::motion);
  std::istringstream csv(test::read_file(folder_ / "wheel.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "t,v_mps,yaw_rate_radps");
  for (const WheelSample& sample : reading.samples) {
    double t_s = 0, v_mps = 0, yaw_rate_radps = 0;
    ASSERT_TRUE(std::getline(csv, line));
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &t_s, &v_mps, &yaw_rate_radps), 3);
    EXPECT_NEAR(t_s, sample.received.seconds(), 2e-6);
    EXPECT_NEAR(v_mps, sample.speed_mps, 1e-3);
    EXPECT_NEAR(yaw_rate_radps, sample.yaw_rate_radps, 1e-3);
  }
}

TEST_F(SimulatedWheels, FolderThatCannotBeWrittenIsNamed) {
  const test::Drive drive(1);
  const auto log = write_wheel(drive.context, {}, folder_ / "none");
  ASSERT_FALSE(log.ok());
  EXPECT_NE(log.error().message.find("can.log"), std::string::npos);
}

TEST(SimulatedWheelKeys, AreReadAndChecked) {
  const auto problems_of = [](const char* text, WheelConfig& config) {
    Problems problems;
    YamlSection section(YAML::Load(text), "wheel", "scenario.yaml", problems);
    read_keys(section, config);
    section.reject_unknown();
    return problems;
  };
  WheelConfig config;
  EXPECT_TRUE(
      problems_of("{protocol: toyota, rate_hz: 40, track_m: 1.6, csv: true, slip_per_minute: 2}", config).empty());
  EXPECT_EQ(config.protocol, WheelProtocol::toyota);
  EXPECT_EQ(config.rate_hz, 40);
  EXPECT_TRUE(config.csv);
  EXPECT_EQ(config.slip_part, WheelConfig{}.slip_part);
  EXPECT_EQ(problems_of("{protocol: honda, track_m: 1600, rate: 1, interface: 'a b'}", config).size(), 4U);
}

// can-utils read the log as their own.
TEST_F(SimulatedWheels, WitnessLog2asc) {
  if (!test::has_program("log2asc")) GTEST_SKIP() << "no log2asc (can-utils)";
  const test::Drive drive(5, test::open_ground(), {{"can_bus_off", 3, 4, 0}});
  const Reading reading = read(drive, exact(WheelProtocol::toyota), WheelSource::rear_wheels);
  const std::string log = (folder_ / "can.log").string(), asc = (folder_ / "can.asc").string();
  ASSERT_EQ(std::system(("log2asc -I '" + log + "' -O '" + asc + "' can0").c_str()), 0);
  std::istringstream lines(test::read_file(asc));
  std::size_t frames = 0, wheels = 0;
  for (std::string line; std::getline(lines, line);) {
    frames += line.find(" Rx ") != std::string::npos;
    wheels += line.find(" AA ") != std::string::npos && line.find(" d 8 ") != std::string::npos;
  }
  EXPECT_EQ(frames, reading.log.frames);
  EXPECT_GE(wheels, reading.counts.samples);
}

}  // namespace
}  // namespace lxd::sim::simulator_wheel_test
