// SPDX-License-Identifier: Apache-2.0
// Text of a sensor, a line a sample: headings, line ends, exact times, and lines that are no row.
#include <gtest/gtest.h>

#include "drivers/replay/csv_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::drivers_csv_log_test {
namespace {

class CsvLogTest : public testing::Test {
 protected:
  using Row = CsvLog<2>::Row;
  std::vector<Row> read(const std::string& text) {
    test::write_file(folder_ / "a.csv", text);
    auto log = CsvLog<2>::open(folder_ / "a.csv");
    EXPECT_TRUE(log.ok());
    std::vector<Row> rows;
    for (Row row; log->next(row);) rows.push_back(row);
    bad_lines_ = log->rejected().contains("bad_line") ? log->rejected().at("bad_line") : 0;
    return rows;
  }
  test::TemporaryFolder folder_;
  std::uint64_t bad_lines_ = 0;
};

TEST_F(CsvLogTest, RowsAreTimesAndNumbersInTheirOrder) {
  const auto rows = read("1767268800.123456789,1.5,-2\n1767268800.2,1e-3,0\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].t.ns(), 1'767'268'800'123'456'789);
  EXPECT_EQ(rows[0].values, (std::array<double, 2>{1.5, -2}));
  EXPECT_EQ(rows[1].values, (std::array<double, 2>{1e-3, 0}));
  EXPECT_EQ(bad_lines_, 0U);
}

TEST_F(CsvLogTest, HeadingsAreNoBadLinesWhateverTheirNumber) {
  EXPECT_EQ(read("t,speed,rate\n1,2,3\n").size(), 1U);
  EXPECT_EQ(bad_lines_, 0U);
  EXPECT_EQ(read("# of a robot\n#\n\nt,speed,rate\n1,2,3\n").size(), 1U);
  EXPECT_EQ(bad_lines_, 0U);
  EXPECT_EQ(read("1,2,3\nt,speed,rate\n2,3,4\n").size(), 2U);
  EXPECT_EQ(bad_lines_, 1U);
}

TEST_F(CsvLogTest, LineEndsOfEverySystemAndBlanksAroundNumbersAreTaken) {
  const auto rows = read("t,a,b\r\n1,2,3\r\n2, 4 ,5 \r\n3,6,7");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].values, (std::array<double, 2>{4, 5}));
  EXPECT_EQ(rows[2].values, (std::array<double, 2>{6, 7}));
  EXPECT_EQ(bad_lines_, 0U);
}

TEST_F(CsvLogTest, LinesThatAreNoRowAreCountedAndPassedOver) {
  for (const std::string bad : {"", "2", "2,3", "2,3,", "2,,4", "2,x,4", "2,3,4x", "2,3,nan", "2,inf,4", "x,3,4",
                                ",3,4", "2;3;4", "2,3,1e999", "nan,3,4", "\xff\xfe"}) {
    const auto rows = read("1,2,3\n" + bad + "\n5,6,7\n");
    EXPECT_EQ(rows.size(), 2U) << bad;
    EXPECT_EQ(bad_lines_, 1U) << bad;
  }
}

TEST_F(CsvLogTest, ARowThatIsCutAnywhereIsARowOrABadLineAndNeverAnothersNumbers) {
  const std::string whole = "1,2,3\n4.5,-6.25,7.125";
  for (std::size_t length = 6; length < whole.size(); ++length) {
    const auto rows = read(whole.substr(0, length));
    ASSERT_GE(rows.size(), 1U);
    EXPECT_EQ(rows.size() + bad_lines_, length == 6 ? 1U : 2U) << length;
    if (rows.size() == 2) {
      EXPECT_EQ(rows[1].values[0], -6.25) << length;
    }
  }
}

TEST_F(CsvLogTest, MoreColumnsThanWantedAreLeft) {
  const auto rows = read("1,2,3,4,5\n");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].values, (std::array<double, 2>{2, 3}));
}

TEST_F(CsvLogTest, AnEmptyFileHasNoRowsAndAMissingOneIsAnError) {
  EXPECT_TRUE(read("").empty());
  const auto missing = CsvLog<2>::open(folder_ / "none.csv");
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message.find("none.csv: cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace lxd::drivers_csv_log_test
