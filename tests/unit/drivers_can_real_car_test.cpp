// SPDX-License-Identifier: Apache-2.0
// A real car's bus against the wheel speeds that others decoded from it.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "drivers/replay/can_log.hpp"
#include "drivers/wheel/wheel_decoder.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::drivers_can_real_car_test {
namespace {

WheelDecoderConfig toyota() { return {toyota_messages(), WheelSource::rear_wheels, 1.57}; }

// A minute of a RAV4's two buses, with the wheel speeds as another program decoded them.
class RealCar : public testing::Test {
 protected:
  struct Row {
    double t_s, fl_mps, fr_mps, rl_mps, rr_mps;
  };
  static std::vector<Row> read_rows(const std::filesystem::path& path) {
    std::vector<Row> rows;
    std::istringstream file(test::read_file(path));
    std::string line;
    std::getline(file, line);
    for (Row row; std::getline(file, line); rows.push_back(row))
      std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &row.t_s, &row.fl_mps, &row.fr_mps, &row.rl_mps, &row.rr_mps);
    return rows;
  }
  // The table has nine digits: rounded to them, ours are the same.
  static void expect_published(double ours_mps, double published_mps) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), "%.9g", ours_mps);
    EXPECT_NEAR(std::strtod(digits.data(), nullptr), published_mps, 1e-9);
  }
  static void expect_row(const CanFrame& frame, const Row& row) {
    const CanMessage& wheels = *find_message(toyota_messages(), 0x0AA);
    const CanValues values = decode_signals(wheels, frame.data);
    EXPECT_EQ(frame.received, RigTime::from_seconds(row.t_s));
    expect_published(values[CanRole::front_left].value(), row.fl_mps);
    expect_published(values[CanRole::front_right].value(), row.fr_mps);
    expect_published(values[CanRole::rear_left].value(), row.rl_mps);
    expect_published(values[CanRole::rear_right].value(), row.rr_mps);
  }

  // Every wheel frame of the log against its row.
  static void expect_agreement(const std::filesystem::path& log, const std::vector<Row>& rows) {
    auto reader = CanLogReader::open(log);
    ASSERT_TRUE(reader.ok());
    WheelDecoder decoder(toyota());
    CanLogRecord record;
    std::size_t row = 0;
    while (reader->next(record)) {
      if (record.interface_name() != "can0") continue;
      decoder.decode(record.frame);
      if (record.frame.id != 0x0AA) continue;
      ASSERT_LT(row, rows.size());
      expect_row(record.frame, rows[row++]);
    }
    EXPECT_EQ(row, rows.size());
    EXPECT_EQ(reader->garbage(), 0U);
    EXPECT_EQ(decoder.counts().samples, rows.size());
    EXPECT_EQ(decoder.counts().bad_checksum + decoder.counts().bad_length + decoder.counts().fault_bit, 0U);
    EXPECT_GT(decoder.counts().other_frames, rows.size());
  }
};

TEST_F(RealCar, ExcerptAgrees) {
  const std::filesystem::path folder = test::clone_data("can");
  const std::vector<Row> rows = read_rows(folder / "toyota_rav4_wheel_speed.csv");
  ASSERT_EQ(rows.size(), 80U);
  expect_agreement(folder / "toyota_rav4.candump", rows);
}

// The same, with the minute whole.
class RealCarMinute : public RealCar {
 protected:
  void SetUp() override {
    const auto packed = test::shared_data("can/toyota_rav4_60s.candump.xz");
    if (!packed) GTEST_SKIP() << "no LXD_SHARED_DATA with can/toyota_rav4_60s.candump.xz";
    if (std::system(("xz -dc '" + packed->string() + "' > '" + log().string() + "'").c_str()) != 0)
      GTEST_SKIP() << "no xz";
  }
  [[nodiscard]] std::filesystem::path log() const { return folder_ / "car.log"; }

  // The length of the true path from the first sample on, and the path's last time.
  static double driven_m(RigTime from, RigTime& to) {
    std::istringstream file(test::read_file(*test::shared_data("can/toyota_rav4_truth_ecef.csv")));
    std::string line;
    std::getline(file, line);
    std::optional<Eigen::Vector3d> last;
    double length_m = 0;
    while (std::getline(file, line)) {
      double t_s = 0;
      Eigen::Vector3d p;
      if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &t_s, &p.x(), &p.y(), &p.z()) != 4) continue;
      if (RigTime::from_seconds(t_s) < from) continue;
      if (last) length_m += (p - *last).norm();
      last = p;
      to = RigTime::from_seconds(t_s);
    }
    return length_m;
  }

  [[nodiscard]] std::vector<WheelSample> samples_by(const WheelDecoderConfig& config) const {
    auto reader = CanLogReader::open(log());
    EXPECT_TRUE(reader.ok());
    WheelDecoder decoder(config);
    std::vector<WheelSample> samples;
    for (CanLogRecord record; reader->next(record);) {
      if (record.interface_name() != "can0") continue;
      if (const auto sample = decoder.decode(record.frame)) samples.push_back(*sample);
    }
    return samples;
  }

  test::TemporaryFolder folder_;
};

// Speeds summed up over time give the length that the car has driven.
TEST_F(RealCarMinute, DeadReckoningGivesTheDrivenLength) {
  WheelDecoderConfig all = toyota();
  all.source = WheelSource::four_wheels;
  all.wheelbase_m = 2.66;
  for (const bool four : {false, true}) {
    const WheelDecoderConfig config = four ? all : toyota();
    const std::vector<WheelSample> samples = samples_by(config);
    ASSERT_EQ(samples.size(), 4974U);
    RigTime end;
    const double truth_m = driven_m(samples.front().received, end);
    double length_m = 0;
    for (std::size_t i = 1; i < samples.size() && samples[i].received <= end; ++i) {
      const double mean_mps = (samples[i - 1].speed_mps + samples[i].speed_mps) / 2;
      length_m += mean_mps * (samples[i].received - samples[i - 1].received).seconds();
    }
    EXPECT_GT(truth_m, 1000);
    RecordProperty(four ? "four_wheels_m" : "two_wheels_m", std::to_string(length_m));
    RecordProperty("driven_m", std::to_string(truth_m));
    EXPECT_NEAR(length_m, truth_m, 0.01 * truth_m);
  }
}

TEST_F(RealCarMinute, WholeMinuteAgrees) {
  const auto table = test::shared_data("can/toyota_rav4_wheel_speed.csv");
  ASSERT_TRUE(table);
  const std::vector<Row> rows = read_rows(*table);
  ASSERT_EQ(rows.size(), 4974U);
  expect_agreement(log(), rows);
}

}  // namespace
}  // namespace lxd::drivers_can_real_car_test
