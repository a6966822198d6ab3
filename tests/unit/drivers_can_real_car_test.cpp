// SPDX-License-Identifier: Apache-2.0
// A real car's bus against the wheel speeds that others decoded from it.
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/replay/can_log.hpp"
#include "drivers/wheel/wheel_decoder.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd {
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
  static void expect_row(const CanFrame& frame, const Row& row) {
    const CanMessage& wheels = *find_message(toyota_messages(), 0x0AA);
    const CanValues values = decode_signals(wheels, frame.data);
    EXPECT_EQ(frame.received, RigTime::from_seconds(row.t_s));
    EXPECT_NEAR(values[CanRole::front_left].value(), row.fl_mps, 1e-7);
    EXPECT_NEAR(values[CanRole::front_right].value(), row.fr_mps, 1e-7);
    EXPECT_NEAR(values[CanRole::rear_left].value(), row.rl_mps, 1e-7);
    EXPECT_NEAR(values[CanRole::rear_right].value(), row.rr_mps, 1e-7);
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

TEST_F(RealCar, WholeMinuteAgrees) {
  const auto packed = test::shared_data("can/toyota_rav4_60s.candump.xz");
  const auto table = test::shared_data("can/toyota_rav4_wheel_speed.csv");
  if (!packed || !table) GTEST_SKIP() << "no LXD_SHARED_DATA with can/toyota_rav4_60s.candump.xz";
  const test::TemporaryFolder folder;
  const std::filesystem::path unpacked = folder / "car.log";
  if (std::system(("xz -dc '" + packed->string() + "' > '" + unpacked.string() + "'").c_str()) != 0)
    GTEST_SKIP() << "no xz";
  const std::vector<Row> rows = read_rows(*table);
  ASSERT_EQ(rows.size(), 4974U);
  expect_agreement(unpacked, rows);
}

}  // namespace
}  // namespace lxd
