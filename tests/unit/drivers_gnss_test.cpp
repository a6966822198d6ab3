// SPDX-License-Identifier: Apache-2.0
// NMEA 0183 as streams: epochs, real receivers' logs, the recording's files, and the frame that positions go to.
#include <algorithm>

#include <gtest/gtest.h>

#include "drivers/gnss/enu.hpp"
#include "drivers/replay/nmea_log.hpp"
#include "drivers/replay/pps_log.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/nmea_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::drivers_gnss_test {
namespace {

using test::bytes;
using test::fixes_of;
using test::sentence;

class NmeaEpochs : public testing::Test {
 protected:
  static std::string gga(const std::string& utc) {
    return sentence("GNGGA," + utc + ",4134.0,N,09345.0,E,4,12,0.6,1.0,M,2.0,M,,");
  }
  static std::string rmc(const std::string& utc, const std::string& date = "130495", char status = 'A') {
    return sentence("GNRMC," + utc + "," + status + ",4134.0,N,09345.0,E,1.0,90.0," + date + ",,,R");
  }
  static std::string gst(const std::string& utc) { return sentence("GNGST," + utc + ",1,1,1,1,0.1,0.2,0.3"); }
  static std::string epoch(const std::string& utc) { return gga(utc) + rmc(utc) + gst(utc); }

  std::vector<GnssFix> feed(const std::string& text, double received_s = 0) {
    std::vector<GnssFix> fixes;
    parser_.feed(bytes(text), RigTime::from_seconds(received_s), [&](const GnssFix& fix) { fixes.push_back(fix); });
    return fixes;
  }
  NmeaParser parser_;
};

TEST_F(NmeaEpochs, EqualTimesAreOneFix) {
  EXPECT_TRUE(feed(epoch("101112.00"), 1).empty());
  const auto fixes = feed(gga("101112.20"), 2);
  ASSERT_EQ(fixes.size(), 1U);
  EXPECT_EQ(fixes[0].received, RigTime::from_seconds(1));
  EXPECT_EQ(fixes[0].quality, GnssQuality::rtk_fixed);
  EXPECT_EQ(fixes[0].sigma_longitude_m, 0.2);
  EXPECT_NEAR(fixes[0].speed_mps.value(), 0.514444, 1e-9);
  EXPECT_TRUE(fixes[0].utc_ns);
}

// Once it is known what an epoch consists of, its last sentence gives the fix.
TEST_F(NmeaEpochs, FixComesWithItsLastSentence) {
  feed(epoch("101112.00"));
  EXPECT_EQ(feed(gga("101112.20") + rmc("101112.20")).size(), 1U);  // of the epoch before
  EXPECT_EQ(feed(gst("101112.20")).size(), 1U);
  EXPECT_TRUE(feed(gga("101112.40") + rmc("101112.40")).empty());
  EXPECT_EQ(feed(gst("101112.40")).size(), 1U);
  EXPECT_FALSE(parser_.flush());
  EXPECT_EQ(parser_.counts().fixes, 3U);
}

TEST_F(NmeaEpochs, SentencesThatComeLaterAreWaitedForFromThenOn) {
  feed(gga("101112.00"));
  EXPECT_EQ(feed(gga("101112.20")).size(), 2U);  // the one before, and this one: a GGA is all that comes, so far
  EXPECT_TRUE(feed(gst("101112.20")).empty());
  EXPECT_EQ(parser_.counts().late, 1U);
  EXPECT_TRUE(feed(gga("101112.40")).empty());
  EXPECT_EQ(feed(gst("101112.40")).size(), 1U);
}

TEST_F(NmeaEpochs, DateGoesOnOverMidnight) {
  feed(rmc("235959.80", "311299"));
  feed(gga("235959.80") + gga("000000.00"));
  const auto fix = parser_.flush();
  ASSERT_TRUE(fix && fix->utc_ns);
  EXPECT_EQ(*fix->utc_ns, 946'684'800 * kNanosPerSecond);  // 2000-01-01
}

TEST_F(NmeaEpochs, LeapSecondIsASecondThatUnixTimeHasTwice) {
  feed(rmc("235960.00", "311216"));
  const auto leap = parser_.flush();
  const auto next = feed(rmc("000000.00", "010117"));
  ASSERT_TRUE(leap && next.size() == 1);
  EXPECT_EQ(leap->time_of_day_ns, 86'400 * kNanosPerSecond);
  EXPECT_EQ(leap->utc_ns, next[0].utc_ns);
}

TEST_F(NmeaEpochs, ReceiversWarningTakesThePosition) {
  feed(gga("101112.00") + rmc("101112.00", "130495", 'V'));
  EXPECT_FALSE(parser_.flush()->has_position());
  feed(rmc("101112.20"));
  EXPECT_TRUE(parser_.flush()->has_position());
}

TEST_F(NmeaEpochs, RefusedSentenceEndsNoEpoch) {
  feed(gga("101112.00"));
  EXPECT_TRUE(feed(sentence("GNGST,101112.20,1,1,1,1,-1,1,1")).empty());
  EXPECT_TRUE(feed(rmc("101112.00")).empty());
  EXPECT_TRUE(parser_.flush()->speed_mps);
}

struct RealLog {
  const char* name;
  std::uint64_t gga, rmc, gst, gsa, lines, bad_checksum, fixes;
};

// Counted by a separate script: lines `$...*HH` whose XOR is right, by the last three letters of the address; fixes are
// distinct UTC fields of GGA. `gpsdecode < log` (gpsd 3.22) gives one position less for each log: it prints an epoch
// when the next begins.
constexpr RealLog kRealLogs[] = {
    {"gr8013-w.log", 3, 3, 3, 6, 48, 0, 3},
    {"quectel-L70.log", 16, 16, 16, 16, 115, 0, 16},
    {"skytraq-fix.log", 11, 11, 11, 11, 100, 0, 11},
    {"st-teseo-liv4f.log", 12, 12, 12, 76, 329, 1, 12},
    {"ublox-neo-m9n-nmea.log", 61, 61, 61, 244, 1403, 0, 61},
    {"ublox-zed-f9p-nmea.log", 29, 29, 29, 116, 1015, 0, 29},
};

class NmeaRealReceivers : public testing::Test {
 protected:
  static void expect_counts(const std::filesystem::path& path, const RealLog& log) {
    NmeaParser parser;
    const std::vector<GnssFix> fixes = fixes_of(parser, test::read_file(path));
    EXPECT_EQ(parser.counts().gga, log.gga) << log.name;
    EXPECT_EQ(parser.counts().rmc, log.rmc) << log.name;
    EXPECT_EQ(parser.counts().gst, log.gst) << log.name;
    EXPECT_EQ(parser.counts().gsa, log.gsa) << log.name;
    EXPECT_EQ(parser.framer_counts().lines, log.lines) << log.name;
    EXPECT_EQ(parser.framer_counts().bad_checksum, log.bad_checksum) << log.name;
    EXPECT_EQ(parser.counts().bad_field, 0U) << log.name;
    EXPECT_EQ(fixes.size(), log.fixes) << log.name;
    EXPECT_EQ(parser.counts().fixes_with_position, log.fixes) << log.name;
    for (const GnssFix& fix : fixes) EXPECT_TRUE(fix.utc_ns && fix.ellipsoid_height_m()) << log.name;
  }
};

TEST_F(NmeaRealReceivers, LogsOfTheClone) {
  for (std::size_t i = 0; i < 3; ++i) expect_counts(test::clone_data("gnss") / kRealLogs[i].name, kRealLogs[i]);
  NmeaParser skytraq, parser;
  const auto some = fixes_of(skytraq, test::read_file(test::clone_data("gnss") / "skytraq-fix.log"));
  const auto has_sigma = [](const GnssFix& fix) { return fix.sigma_latitude_m.has_value(); };
  EXPECT_EQ(std::count_if(some.begin(), some.end(), has_sigma), 4) << "its other GST have empty fields";
  const auto fixes = fixes_of(parser, test::read_file(test::clone_data("gnss") / "ublox-zed-f9p-nmea.log"));
  ASSERT_EQ(fixes.size(), 3U);
  EXPECT_NEAR(fixes[0].latitude_deg.value(), -45.877567166666665, 1e-12);
  EXPECT_EQ(fixes[0].utc_ns.value(), 1'555'029'596 * kNanosPerSecond);  // 2019-04-12T00:39:56Z
}

TEST_F(NmeaRealReceivers, AllSixLogs) {
  for (const RealLog& log : kRealLogs) {
    const auto path = test::shared_data(std::string("gnss/") + log.name);
    if (!path) GTEST_SKIP() << "no LXD_SHARED_DATA with gnss/" << log.name;
    expect_counts(*path, log);
  }
}

TEST(NmeaLogs, LinesBecomeChunksWithTheirTimes) {
  const std::string kRmc = "$GPRMC,210230,A,3855.4487,N,09446.0071,W,0.0,076.2,130495,003.8,E*69\r\n";
  const std::string kEmptyGga = "$GPGGA,,,,,,0,,,,,,,,*66\r\n";
  const test::TemporaryFolder folder;
  test::write_file(folder / "gnss.nmea", "1.250000001 " + kRmc + "no time\n\n2.5 " + kEmptyGga + "3.0");
  auto log = NmeaLog::open(folder / "gnss.nmea");
  ASSERT_TRUE(log.ok());
  NmeaParser parser;
  std::vector<std::int64_t> times;
  for (NmeaChunk chunk; log->next(chunk);) {
    times.push_back(chunk.received.ns());
    parser.feed(chunk.bytes, chunk.received, [](const GnssFix&) {});
  }
  EXPECT_EQ(times, (std::vector<std::int64_t>{1'250'000'001, 2'500'000'000}));
  EXPECT_EQ(parser.counts().rmc, 1U);
  EXPECT_EQ(log->garbage(), 2U);
  EXPECT_EQ(log->first_garbage_line(), 2U);
  EXPECT_FALSE(NmeaLog::open(folder / "none").ok());
}

TEST(PpsLogs, EdgesWithTheirCount) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "pps.csv", "assert_ns,sequence\r\n1700000000000001234,7\r\n1700000002000001234,9\r\n");
  const auto log = read_pps_log(folder / "pps.csv");
  ASSERT_TRUE(log.ok());
  ASSERT_EQ(log->edges.size(), 2U);
  EXPECT_EQ(log->edges[0], (PpsEdge{RigTime::from_ns(1'700'000'000'000'001'234), 7}));
  EXPECT_EQ(log->lost, 1U);
  for (const char* const content : {"", "time\n", "assert_ns,sequence\n12\n", "assert_ns,sequence\n1,2,3\n",
                                    "assert_ns,sequence\n1,2\n2,2\n", "assert_ns,sequence\nx,2\n"}) {
    test::write_file(folder / "bad.csv", content);
    const auto bad = read_pps_log(folder / "bad.csv");
    ASSERT_FALSE(bad.ok()) << content;
    EXPECT_NE(bad.error().message.find("bad.csv: line"), std::string::npos);
  }
}

TEST(EnuFrames, PlacesGoThereAndBack) {
  const auto frame = EnuFrame::at({37.7, -122.4, 30});
  ASSERT_TRUE(frame.ok());
  EXPECT_LT(frame->to_enu({37.7, -122.4, 30}).norm(), 1e-8);
  const Eigen::Vector3d p(1200, -340, 25);
  const Geodetic place = frame->to_geodetic(p);
  EXPECT_GT(place.longitude_deg, -122.4);
  EXPECT_LT(place.latitude_deg, 37.7);
  EXPECT_LT((frame->to_enu(place) - p).norm(), 1e-7);
  // One minute of latitude is 1850 m here (WGS-84 meridian radius at 37.7 degrees: 6359.4 km).
  EXPECT_NEAR(frame->to_enu({37.7 + 1.0 / 60, -122.4, 30}).y(), 1849.9, 0.5);
}

TEST(EnuFrames, OriginsThatAreNoPlaceAreErrors) {
  EXPECT_FALSE(EnuFrame::at({90.1, 0, 0}).ok());
  EXPECT_FALSE(EnuFrame::at({0, 180.1, 0}).ok());
  EXPECT_FALSE(EnuFrame::at({0, 0, std::numeric_limits<double>::infinity()}).ok());
  EXPECT_FALSE(EnuFrame::at({std::nan(""), 0, 0}).ok());
}

}  // namespace
}  // namespace lxd::drivers_gnss_test
